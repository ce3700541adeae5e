# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What the correction drags moves by its equation of motion."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
from scipy.linalg import expm

from tree_sway.twin.dragged_motion import DraggedMotion
from tree_sway.twin.pushed_twigs import push_of

M, N, DT = 5, 3, 1.0 / 60.0


def test_it_is_the_solution_of_its_equation() -> None:
    rng = np.random.default_rng(2)
    drag, damping = rng.normal(size=(M, M)), rng.uniform(2.0, 3.0, M)
    stiffness, trust = rng.uniform(9.0, 90.0, M), np.array([0.0, 0.4, 1.0])
    push = rng.normal(size=(N, M))
    observer: Any = SimpleNamespace(
        count=N, trust=trust, push=push,
        unknown=SimpleNamespace(
            all_damping=damping, all_stiffness=stiffness, forces=SimpleNamespace(drag=drag)
        ),
    )  # fmt: skip
    dragged, added = DraggedMotion(observer, DT), np.zeros((2, M))
    state, share = np.zeros((M, 2)), np.ones(M)
    share[:N] -= trust
    for steps in (1, 3, 1):
        correction = rng.normal(size=(3, N))
        dragged.step(correction, steps, added)
        by_others = drag[:, :N].copy()
        by_others[range(N), range(N)] = 0.0
        force = share * (push.T @ correction[2] - by_others @ correction[1])
        for i in range(M):
            # x'' = force - (c + D) x' - k x, of which the force is held.
            law = np.array([
                [0.0, 1.0, 0.0], [-stiffness[i], -damping[i] - drag[i, i], force[i]], [0.0] * 3
            ])  # fmt: skip
            state[i] = (expm(law * steps * DT) @ [*state[i], 1.0])[:2]
        np.testing.assert_allclose(dragged.motion, state.T, atol=1e-9 * np.abs(state).max())
        expected = state.T.copy()
        expected[:, :N] += correction[:2]
        np.testing.assert_allclose(added, expected, atol=1e-9)


def test_forces_on_the_stem_push_what_hangs_from_it_as_they_do() -> None:
    rng = np.random.default_rng(4)
    moved, stiffness = rng.normal(size=(1, M)), rng.uniform(9.0, 90.0, M)
    trust, share = np.array([1.0, 0.5, 1.0]), np.array([0.0, 0.5, 0.0, 1.0, 1.0])
    push = push_of(moved, stiffness, trust, share)
    # The part that noise would be of it is left out.
    known = 1.0 / 1.1
    np.testing.assert_allclose((trust * moved[0, :N]) @ push, known * share * moved[0])
    assert not push_of(moved, stiffness, np.zeros(N), share).any()
    assert not push_of(0.0 * moved, stiffness, trust, share).any()
