# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Make the golden poses: every built-in tree, bare, in 60 s of simulated wind, in each reduced model.

    python test/golden/poses/make_golden.py            # writes golden.npz and digests.json here
    python test/golden/poses/make_golden.py --check    # exits with 1 where a digest differs

The digest of all frames is the same bit for bit only on one kind of processor with one compiler; a
restructuring is checked by it, on one machine, before and after. What the test compares on any
machine are the sampled poses in golden.npz, within rounding.

"""

from __future__ import annotations

import hashlib
import json
from pathlib import Path
import sys

import numpy as np

from tree_sway.core.scene.make import make_simulator
from tree_sway.core.wind.turbulence import simulate_turbulence
from tree_sway.growth.builtin import builtin_tree, BUILTIN_TREES

FOLDER = Path(__file__).resolve().parent
MODELS = ('branch', 12, 'full')
RATE, SECONDS = 60, 60
EVERY = 600
"""Steps from one sampled frame to the next."""
SAMPLED = 40
"""Segments sampled per tree, evenly over their order."""


def run(tree_name: str, model: str, seconds: int = SECONDS) -> tuple[str, np.ndarray]:
    """Return the digest of all frames of a run, and the sampled poses, (frames, segments, 7)."""
    tree = builtin_tree(tree_name)
    wind = simulate_turbulence(6.0, rate=RATE, duration=SECONDS, rng=np.random.default_rng(1))
    sim = make_simulator(tree, model=model, in_leaf=False)
    chosen = np.linspace(0, tree.n_segments - 1, SAMPLED).astype(int)
    digest, sampled = hashlib.blake2b(digest_size=16), []
    for count, sample in enumerate(wind[: RATE * seconds], 1):
        sim.step(sample, 1.0 / RATE)
        poses = sim.place()
        digest.update(poses.tobytes())
        if count % EVERY == 0:
            sampled.append(poses[chosen])
    return digest.hexdigest(), np.array(sampled)


def main() -> int:
    """Run all; write, or check against what is stored."""
    digests, sampled = {}, {}
    for tree_name in BUILTIN_TREES:
        for model in MODELS:
            name = f'{tree_name}_{model}'
            digests[name], sampled[name] = run(tree_name, model)
            print(name, digests[name], flush=True)
    if '--check' in sys.argv[1:]:
        stored = json.loads((FOLDER / 'digests.json').read_text(encoding='utf-8'))
        differing = [name for name in digests if digests[name] != stored.get(name)]
        print('differing: ' + (', '.join(differing) or 'none'))
        return int(bool(differing))
    (FOLDER / 'digests.json').write_text(json.dumps(digests, indent=2) + '\n', encoding='utf-8')
    np.savez_compressed(FOLDER / 'golden.npz', **sampled)
    return 0


if __name__ == '__main__':
    sys.exit(main())
