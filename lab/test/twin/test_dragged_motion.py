# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A corrected stem drags its hanging twigs as the model itself does."""

from __future__ import annotations

import numpy as np
from tree_sway_lab.twin.true_tree import DT, tree_called

from tree_sway.core.arrays import Floats
from tree_sway.twin.dragged_motion import DraggedMotion
from tree_sway.twin.observed_tree import ObservedTree

WIND, STEPS = (7.0, 0.0, 0.0), 90


def swayed(twin: ObservedTree) -> Floats:
    """Displacement and rate of every step, (n, 2, m)."""
    eta, rate, _ = twin.banks[0].oscillators.swing
    motion = np.empty((STEPS, 2, len(eta)))
    for row in motion:
        twin.step(WIND, DT)
        row[0], row[1] = eta, rate
    return motion


def test_twigs_follow_the_correction_of_the_stem_as_in_the_model() -> None:
    tree, species = tree_called('birch')
    twin = ObservedTree(tree, species, in_leaf=False, at={})
    for _ in range(600):
        twin.step(WIND, DT)
    rest = twin.state()
    as_is = swayed(twin)
    twin.set_state(rest)
    observer = twin.observer
    drag = observer.unknown.present_forces(keeps_old=True).drag
    stem = int(np.diag(drag)[: observer.count].argmin())
    twin.banks[0].oscillators.swing[1][stem] += 1e-3
    change = swayed(twin) - as_is

    observer.trust[stem] = 1.0
    dragged, correction = DraggedMotion(observer, DT), np.zeros((3, observer.count))
    found = np.empty_like(change[:, 0])
    for k in range(STEPS):
        correction[1, stem] = change[k, 1, stem]
        dragged.step(correction, 1, np.empty_like(change[k]))
        found[k] = dragged.motion[0]
    twigs = np.arange(found.shape[1]) != stem
    assert not found[:, stem].any()
    wanted = change[:, 0, twigs]
    missed = np.linalg.norm(found[:, twigs] - wanted) / np.linalg.norm(wanted)
    print(f'missed {missed:.2f}')
    assert missed < 0.7
