# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Motion of the coordinates without correction that the correction of others causes.

A stem that sways otherwise than in the wind alone moves its hanging twigs, by the air and by the
wood. Drag couples the coordinates of both. And an unknown force on one coordinate alone pushes the
twigs against the stem, by the shape of that coordinate, where in truth they hang from a stem that
leans farther. So it is taken for a force on the wood at the sensors, which pushes all of them::

    x_u'' + c_u x_u' + k_u x_u = (1 - t_u) sum over j of  P_uj t_j d_j - D_uj v_j

v_j are the rates of the correction and d_j its unknown forces, D the drag per rate in the mean
wind, P the push (`pushed_twigs`), t_u the share of the correction of u that is applied, and c_u,
k_u damping, by wood and air, and stiffness.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.native import LastAddress, LIBRARY, NativeDragged
from tree_sway.core.oscillators import held_propagator

if TYPE_CHECKING:
    from tree_sway.twin.disturbance import Disturbance
    from tree_sway.twin.observer import Observer


class DraggedMotion:
    """
    What the correction of an observer moves by drag and by its forces.

    Parameters
    ----------
    observer
        The observer.
    dt
        Time step in [s].

    """

    def __init__(self, observer: Observer, dt: float) -> None:
        self._unknown, self._dt = observer.unknown, dt
        m = len(observer.unknown.all_damping)
        self._state = np.zeros((3, m))
        self.motion = self._state[:2]
        """Displacement and rate of each coordinate, (2, m)."""
        self._law = np.zeros((2, 3, m))
        self._drag = np.zeros((observer.count, m))
        self._native = NativeDragged(
            coordinates=m, corrected=observer.count, law=self._law,
            drag=self._drag, push=observer.push, trust=observer.trust, state=self._state,
        )  # fmt: skip
        self._given_at, self._out_at = LastAddress(), LastAddress()
        self._found_for: tuple[Disturbance | None, Floats | None] = None, None

    def step(self, correction: Floats, n_periods: int, out: Floats) -> None:
        """
        Move by some time steps.

        Parameters
        ----------
        correction
            Displacement, rate and force of the correction that is applied, (3, count).
        n_periods
            Number of time steps.
        out
            The correction with what it drags, of each coordinate, (2, m), written.

        """
        present = self._unknown.forces, self._unknown.all_damping
        if any(now is not then for now, then in zip(present, self._found_for, strict=True)):
            self._find_law()
            self._found_for = present
        given_at, out_at = self._given_at.of(correction), self._out_at.of(out)
        LIBRARY.sway_drag(self._native.at, given_at, n_periods, out_at)

    def _find_law(self) -> None:
        """Find how the coordinates move in the present wind, with its drag per rate (m, m)."""
        unknown = self._unknown
        if unknown.forces is None:
            return
        drag = unknown.forces.drag
        own = np.diag(drag)
        damping = unknown.all_damping + own
        self._law[:] = held_propagator(damping, unknown.all_stiffness, self._dt)
        self._drag[:] = (np.diag(own) - drag)[:, : len(self._drag)].T

    def reset(self) -> None:
        """Return to rest."""
        self._state[:] = 0.0
