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

from typing import TYPE_CHECKING

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.oscillators.propagator import held_propagator

if TYPE_CHECKING:
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
        self._terms = np.zeros((2, 3, m))
        self._share = np.ones(m)
        self._drag = np.zeros((m, observer.count))
        self._found_for: tuple[object, object] = (None, None)

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
        present = (forces, observer.damping)
        if any(now is not then for now, then in zip(present, self._found_for, strict=True)):
            self._find_law(forces.drag)
            self._found_for = present
        np.subtract(1.0, observer.trust, out=self._share[: observer.count])
        force = np.dot(self._drag, rates, out=self._state[2])
        force *= self._share
        for _ in range(n_periods):
            np.multiply(self._law, self._state, out=self._terms)
            np.add.reduce(self._terms, axis=1, out=self.motion)
        return self.motion

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
