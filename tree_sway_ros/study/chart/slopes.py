# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``tree-sway chart slopes``: how response spectra of grown trees fall above their first peak."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from tree_sway_ros.core.wind.crown_wind import USUAL_COHERENCE
from tree_sway_ros.study.validation.response_slopes import SPECIES, Slopes, response_slopes


def chart_slopes(
    out_dir: str | Path, *, species: Iterable[str] = SPECIES, seconds: float = 1200.0
) -> dict[tuple[str, bool, float], Slopes]:
    """
    Measure slopes in one wind for the whole crown and limb by limb, and write ``slopes.md``.

    Parameters
    ----------
    out_dir
        Folder to write into; made if it is not there.
    species
        Of `SPECIES`.
    seconds
        Length of each run in [s].

    Returns
    -------
    dict
        Slopes by species, whether it is in leaf, and `crown_coherence`.

    """
    found: dict[tuple[str, bool, float], Slopes] = {}
    shares = (1.0, USUAL_COHERENCE)
    lines = [
        "| species | leaves | " + " | ".join(f"coherence {share:g}" for share in shares) + " |",
        "|---" * (2 + len(shares)) + "|",
    ]
    for one in species:
        for in_leaf in (False, True):
            cells = []
            for share in shares:
                slopes = response_slopes(one, coherence=share, in_leaf=in_leaf, seconds=seconds)
                found[one, in_leaf, share] = slopes
                cells.append(f"{slopes.along:.1f}, {slopes.across:.1f}")
            lines.append(f"| {one} | {'on' if in_leaf else 'off'} | " + " | ".join(cells) + " |")
    lines += ["", "Slopes along the wind and across it, from 1.3 to 3.5 times the first frequency."]
    folder = Path(out_dir)
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "slopes.md").write_text("\n".join(lines) + "\n", encoding="utf-8")
    return found
