# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A scene that is solved by the receiver: exported tables, and the places of the trees.

It is the solver of ``static/sway.js`` in Python, and its reference in tests.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.kernel import WHY_PLAIN
from tree_sway.core.model.exported_table import table_of
from tree_sway.core.model.records import instance_layout, time_step_layout
from tree_sway.core.oscillators.propagator import propagator
from tree_sway.core.run.clamp_watch import ClampWatch, fewer
from tree_sway.core.run.table_model import (
    bent_too_far,
    come_to_rest,
    drop,
    fill_time_step,
    Propagators,
)
from tree_sway.core.scene.placement_records import own_steps, placement_records
from tree_sway.core.wind.gust_travel import GustHistory
from tree_sway.errors import ParameterError

if WHY_PLAIN:
    from tree_sway.core.run.numpy_stand import step_stand
else:
    from tree_sway.core.run.stand import step_stand

_SLOWEST = 0.3
"""Smallest response to a rate within a time step, over that of the slowest coordinate."""


_LAW = 3
"""Numbers of a `DragLaw`."""


@dataclass(frozen=True)
class ReceivedKind:
    """Trees of one table: numbers and arrays of `exported_table`, and their `DragLaw`."""

    numbers: Mapping[str, float]
    arrays: Mapping[str, NDArray[Any]]
    drag_law: Sequence[float]


class ReceivedScene:
    """
    Trees on exported tables in one wind.

    Parameters
    ----------
    kinds
        Tables of the kinds.
    kind_of
        The table of each tree, (t,).
    places
        x, y, z [m], turn about the vertical [rad] and scale of each tree, (t, 5).
    speeds
        Wind of each tree over that of its kind, (t,).
    anemometer, convection_ratio
        Arguments of `GustHistory`.
    dt
        Time step in [s].

    Raises
    ------
    ParameterError
        A tree of a kind that is not there, or arrays of different lengths.

    """

    def __init__(
        self, kinds: Sequence[ReceivedKind], kind_of: Ints, places: Floats, speeds: Floats, *,
        dt: float, anemometer: ArrayLike | None = None, convection_ratio: float = 1.0,
    ) -> None:  # fmt: skip
        """Begin at rest; a `ParameterError` for arrays that the kernel would read past its end."""
        _check(kinds, kind_of, places, speeds)
        self._dt = dt
        self._sizes = [len(kind.arrays['stiffness']) for kind in kinds]
        m = max(self._sizes)
        self.tables = np.concatenate([table_of(k.numbers, k.arrays, m) for k in kinds])
        self.instances = np.zeros(len(places), dtype=instance_layout(m))
        self._laws = np.array([kind.drag_law for kind in kinds])
        self._kind_of = np.asarray(kind_of)
        found, step = own_steps(self._kind_of, places[:, 4], dt)
        self._time_steps = np.zeros(len(found), dtype=time_step_layout(m))
        for own, (number, own_dt) in zip(self._time_steps, found, strict=True):
            arrays = kinds[number].arrays
            damping = arrays['own_damping']
            stiffness = arrays['stiffness']
            whole, half = (
                propagator(1.0, damping, stiffness, span) for span in (own_dt, 0.5 * own_dt)
            )
            fill_time_step(own, Propagators(damping, stiffness, whole, half), own_dt)
        self._placed = placement_records(self._kind_of, places, speeds)
        self._placed['time_step'] = self._full_steps = step
        self._steps = 0
        self._watches = dict[int, ClampWatch]()
        self.reduced = 0
        """Times that a tree whose steps stayed clamped continued on fewer coordinates."""
        self.gusts = GustHistory(places[:, :3], anemometer, convection_ratio=convection_ratio)
        self._states = [kind.arrays['state'].astype(np.float64) for kind in kinds]
        self._corrections = [kind.arrays['correction'].astype(np.float64) for kind in kinds]
        described = np.array([len(kind.arrays['correction']) for kind in kinds])
        self._first = np.concatenate([[0], np.cumsum(described[self._kind_of])])

    def step(self, wind: ArrayLike) -> int:
        """
        Advance by a step of mean wind (3,) in [m/s]; count trees that were clamped.

        A tree whose steps stay clamped continues from rest on fewer coordinates.
        """
        winds = self.gusts.push(wind, self._dt)
        arrays = self.tables, self._time_steps, self._placed, self.instances, self._laws
        clamped = step_stand(*arrays, winds)[0]
        self._steps += 1
        if clamped:
            self._watch_clamped()
        return clamped

    def _watch_clamped(self) -> None:
        """Solve fewer coordinates of the trees whose steps stay clamped."""
        most = self.tables['most_pressure'][self._kind_of]
        for number in np.flatnonzero(bent_too_far(self.instances, most)).tolist():
            watch = self._watches.setdefault(number, ClampWatch())
            if not watch.is_stuck(self._steps, self._dt):
                continue
            before = self._count(number)
            count = fewer(before)
            if count < before:
                come_to_rest(self.instances[number : number + 1])
                self.instances['left_out'][number] += before - count
                own = self._time_steps[self._placed['time_step'][number]].copy()
                drop(own, count)
                self._placed['time_step'][number] = len(self._time_steps)
                self._time_steps = np.append(self._time_steps, own)
                self.reduced += 1

    def _count(self, tree: int) -> int:
        """Return the number of coordinates of a tree that are solved."""
        return self._sizes[int(self._kind_of[tree])] - int(self.instances['left_out'][tree])

    def coordinates(self, tree: int) -> Floats:
        """Modal coordinates of a tree, (m,)."""
        size = self._sizes[int(self._kind_of[tree])]
        return np.asarray(self.instances['eta'][tree, :size])

    def state(self) -> Floats:
        """Coordinates of the description of all trees, (M,)."""
        states = []
        for own, kind in zip(self.instances['eta'], self._kind_of.tolist(), strict=True):
            states.append(own[: self._sizes[kind]] @ self._states[kind])
        return np.concatenate(states)

    def correct(self, values: Floats, first: int = 0, steps: float = math.inf) -> None:
        """
        Set the first described coordinates to values (c,).

        Rates change as if that took a number of time steps.
        """
        change = np.zeros(self._first[-1])
        part = slice(first, first + len(values))
        change[part] = values - self.state()[part]
        for tree, kind in enumerate(self._kind_of.tolist()):
            own = change[self._first[tree] : self._first[tree + 1]] @ self._corrections[kind]
            instance = self.instances[tree]
            count = self._count(tree)
            whole = self._time_steps['whole'][self._placed['time_step'][tree], :, :count]
            instance['eta'][:count] += own[:count]
            way = np.maximum(whole[1], _SLOWEST * whole[1].max())
            instance['rate'][:count] += own[:count] * whole[5] / (way * steps)

    def reset(self) -> None:
        """Return to rest, without wind."""
        self.instances[:] = np.zeros((), dtype=self.instances.dtype)
        self._placed['time_step'] = self._full_steps
        self._watches.clear()
        self.gusts.reset()


def _check(kinds: Sequence[ReceivedKind], kind_of: Ints, places: Floats, speeds: Floats) -> None:
    """Refuse numbers of kinds that do not exist, and arrays of wrong lengths."""
    count = len(kind_of)
    is_known = (kind_of >= 0) & (kind_of < len(kinds))
    for name, holds in (
        ('kind_of', bool(is_known.all())),
        ('places', places.shape == (count, 5)),
        ('speeds', speeds.shape == (count,)),
        ('drag_law', all(len(kind.drag_law) == _LAW for kind in kinds)),
    ):
        if not holds:
            raise ParameterError('it does not fit the rest', where=name)
