# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Motion of the coordinates without correction that the correction of others causes by drag.

A stem that sways otherwise than in the wind alone moves its hanging twigs through the air, whose
drag couples the coordinates of both. Without it, twigs would follow the corrected stem as they do
in still air, which is another amplitude and phase::

    x_u'' + c_u x_u' + k_u x_u = - (1 - t_u) sum over j of D_uj v_j

v_j are the rates of the correction, D the drag per rate in the mean wind, t_u the share of the
correction of u that is applied, and c_u, k_u damping, by wood and air, and stiffness.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.kernel import entry_of, kernel, WHY_PLAIN
from tree_sway.core.oscillators.propagator import held_propagator

if TYPE_CHECKING:
    from tree_sway.core.observe.disturbance import Disturbance
    from tree_sway.core.observe.observer import Observer


class DraggedMotion:
    """
    What the correction of an observer moves by drag.

    Parameters
    ----------
    observer
        The observer.
    dt
        Time step in [s].

    """

    def __init__(self, observer: Observer, dt: float) -> None:
        self._observer = observer
        self._dt = dt
        m = len(observer.damping)
        self._state = np.zeros((3, m))
        self.motion = self._state[:2]
        """Displacement and rate of each coordinate, (2, m)."""
        self._law = np.zeros((2, 3, m))
        self._drag = np.zeros((m, observer.count))
        self._found_for: tuple[Disturbance | None, Floats | None] = None, None

    def step(self, rates: Floats, n_periods: int) -> Floats:
        """
        Move by some time steps.

        Parameters
        ----------
        rates
            Rates of the correction that is applied, (count,).
        n_periods
            Number of time steps.

        Returns
        -------
        Floats
            Displacement and rate of each coordinate, (2, m). The array is reused.

        """
        observer = self._observer
        forces = observer.forces
        if forces is None:
            return self.motion
        damping = observer.damping
        if forces is not self._found_for[0] or damping is not self._found_for[1]:
            self._find_law(forces.drag)
            self._found_for = forces, damping
        self._move(self._law, self._drag, observer.trust, rates, n_periods, self._state)
        return self.motion

    @cached_property
    def _move(self) -> Callable[..., None]:
        if WHY_PLAIN:
            return move_dragged_in_numpy
        trust = self._observer.trust
        return entry_of(move_dragged, self._law, self._drag, trust, trust, 1, self._state)

    def _find_law(self, drag: Floats) -> None:
        """Find how the coordinates move in the present wind, with drag per rate (m, m)."""
        observer = self._observer
        damping = observer.damping + np.diag(drag)
        stiffness = observer.all_stiffness
        self._law[:] = held_propagator(damping, stiffness, self._dt)
        by_others = drag.copy()
        np.fill_diagonal(by_others, 0.0)
        self._drag[:] = -by_others[:, : observer.count]

    def reset(self) -> None:
        """Return to rest."""
        self._state[:] = 0.0


@kernel
def move_dragged(
    law: Floats, drag: Floats, trust: Floats, rates: Floats, n_periods: int, state: Floats
) -> None:
    """
    Move what is dragged by some time steps.

    Parameters
    ----------
    law
        Displacement and rate after a step by those before and the force, (2, 3, m).
    drag
        Force on each coordinate per rate of the corrected ones, (m, n).
    trust, rates
        Share of the correction that is applied, and its rate, (n,).
    n_periods
        Number of time steps.
    state
        Displacement, rate and force, (3, m), written.

    """
    for i in range(len(drag)):
        force = 0.0
        for j in range(len(rates)):
            force += drag[i, j] * rates[j]
        if i < len(trust):
            force *= 1.0 - trust[i]
        state[2, i] = force
        for _ in range(n_periods):
            eta, rate = state[0, i], state[1, i]
            for k in range(2):
                state[k, i] = law[k, 0, i] * eta + law[k, 1, i] * rate + law[k, 2, i] * force


def move_dragged_in_numpy(
    law: Floats, drag: Floats, trust: Floats, rates: Floats, n_periods: int, state: Floats
) -> None:
    """Move what is dragged as `move_dragged`."""
    np.dot(drag, rates, out=state[2])
    state[2, : len(trust)] *= 1.0 - trust
    for _ in range(n_periods):
        state[:2] = (law * state).sum(axis=1)
