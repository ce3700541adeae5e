# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A scene that is solved by the receiver: exported tables, and the places of the trees.

`StreamClient` solves so where it asks for the wind alone, as the page does (``static/sway.js``).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
import math

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.native import bytes_of, NativeModel, NativeStand
from tree_sway.core.oscillators import propagator
from tree_sway.core.run import bent_too_far, ClampWatch, come_to_rest, fewer
from tree_sway.core.scene import own_step
from tree_sway.core.wind.gusts import GustHistory
from tree_sway.errors import ParameterError
from tree_sway.stream.check_description import Arrays
from tree_sway.stream.table_export import arrays_of_table

_SLOWEST = 0.3
"""Smallest response to a rate within a time step, over that of the slowest coordinate."""


_LAW = 3
"""Numbers of a `DragLaw`."""


@dataclass(frozen=True)
class ReceivedKind:
    """Trees of one table: numbers and arrays of `exported_table`, and their `DragLaw`."""

    numbers: Mapping[str, float]
    arrays: Arrays
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
        """Begin at rest; a `ParameterError` for arrays that a step would read past their end."""
        _check(kinds, kind_of, places, speeds)
        self._dt = dt
        self._kind_of = np.asarray(kind_of)
        own_kinds = [kinds[kind] for kind in self._kind_of.tolist()]
        self._sizes = [len(kind.arrays['stiffness']) for kind in own_kinds]
        models = [_native(kind) for kind in kinds]
        self.stand = NativeStand(models, self._kind_of, places, speeds)
        self.stand.set_step(dt)
        self._most_pressure = np.array([kind.numbers['most_pressure'] for kind in kinds])
        pairs = zip(own_kinds, places[:, 4].tolist(), strict=True)
        self._way = [_way(kind, own_step(scale, dt)) for kind, scale in pairs]
        self._steps = 0
        self._watches = dict[int, ClampWatch]()
        self.reduced = 0
        """Times that a tree whose steps stayed clamped continued on fewer coordinates."""
        self.gusts = GustHistory(places[:, :3], anemometer, convection_ratio=convection_ratio)
        self._states = [kind.arrays['state'].astype(np.float64) for kind in kinds]
        self._corrections = [kind.arrays['correction'].astype(np.float64) for kind in kinds]
        described = [len(kind.arrays['correction']) for kind in own_kinds]
        self._first = np.cumsum([0, *described])

    def step(self, wind: ArrayLike) -> int:
        """
        Advance by a step of mean wind (3,) in [m/s]; count trees that were clamped.

        A tree whose steps stay clamped continues from rest on fewer coordinates.
        """
        winds = self.gusts.push(wind, self._dt)
        clamped = self.stand.step(winds)[0]
        self._steps += 1
        if clamped:
            self._watch_clamped()
        return clamped

    def _watch_clamped(self) -> None:
        """Solve fewer coordinates of the trees whose steps stay clamped."""
        states = self.stand.states
        is_bent = bent_too_far(states, self._most_pressure[self._kind_of])
        for number in np.flatnonzero(is_bent).tolist():
            watch = self._watches.setdefault(number, ClampWatch())
            if not watch.is_stuck(self._steps, self._dt):
                continue
            before = self._count(number)
            count = fewer(before)
            if count < before:
                come_to_rest(states, number)
                states.left_out[number] += before - count
                states.at_rest[number] = states.left_out[number]
                self.reduced += 1

    def _count(self, tree: int) -> int:
        """Return the number of coordinates of a tree that are solved."""
        return self._sizes[tree] - int(self.stand.states.left_out[tree])

    def coordinates(self, tree: int) -> Floats:
        """Modal coordinates of a tree, (m,)."""
        return self.stand.states.eta[tree, : self._sizes[tree]]

    def state(self) -> Floats:
        """Coordinates of the description of all trees, (M,)."""
        trees = zip(self.stand.states.eta, self._sizes, self._kind_of.tolist(), strict=True)
        return np.concatenate([eta[:size] @ self._states[kind] for eta, size, kind in trees])

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
            states = self.stand.states
            count = self._count(tree)
            states.eta[tree, :count] += own[:count]
            states.rate[tree, :count] += own[:count] * self._way[tree][:count] / steps

    def reset(self) -> None:
        """Return to rest, without wind."""
        self.stand.reset()
        self._watches.clear()
        self.gusts.reset()


def _native(kind: ReceivedKind) -> NativeModel:
    """Return the native model of a table."""
    law = {'drag_law': np.array(kind.drag_law, dtype=np.float64)}
    return NativeModel(bytes_of(law | arrays_of_table(kind.numbers, kind.arrays)))


def _way(kind: ReceivedKind, dt: float) -> Floats:
    """Change of the rate by a change of the displacement over a time step, (m,)."""
    whole = propagator(1.0, kind.arrays['own_damping'], kind.arrays['stiffness'], dt).T
    return whole[5] / np.maximum(whole[1], _SLOWEST * whole[1].max())


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
