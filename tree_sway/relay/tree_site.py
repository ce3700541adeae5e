# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A site: a tree that is solved on a grid of absolute time, as far as its wind is known.

Sites that have the same samples take the same steps and agree bit for bit, whenever the samples
come. One that joins later sets a snapshot of another, or waits until damping has made them alike.
What comes over the line is checked: whoever sends it, nothing is solved that a gate refuses, and
no time is believed that is far from one's own clock.
"""

from __future__ import annotations

import base64
from collections.abc import Callable
import json
import threading
from typing import Any

from tree_sway.core.arrays import Floats
from tree_sway.core.scene.run import Run
from tree_sway.core.simulator.simulator import SwaySimulator
from tree_sway.core.state.tree_state import TreeState
from tree_sway.core.wind.gate import LARGEST_LEAD
from tree_sway.core.wind.intake import GoodWind
from tree_sway.core.wind.limits import is_wind
from tree_sway.errors import StateError, TreeSwayError

PATIENCE = 1.0
"""A site waits this long for a sample [s], then it goes on with the wind it has."""

_SECOND = 1_000_000_000
_OLDEST_SNAPSHOT = 10 * _SECOND
_LARGEST = 1 << 22  # bytes of a snapshot


class Site:
    """
    Steps a tree along samples of wind, at a whole rate [Hz] that all sites have, from any thread.

    ``stepped`` is called after each step with its end [ns] and its mean wind [m/s].
    """

    def __init__(
        self,
        simulator: SwaySimulator,
        rate: int = 60,
        stepped: Callable[[int, Floats], None] = lambda stamp, wind: None,
    ) -> None:
        self.simulator, self.rate = simulator, rate
        self.run = Run(simulator, rate, stepped=stepped)
        self._has_wind = False
        self._lock = threading.RLock()

    def _identity(self) -> dict[str, Any]:
        """Return what sites must agree in."""
        simulator = self.simulator
        agreed = {'tree': simulator.tree.name, 'digest': simulator.digest(), 'rate': self.rate}
        return {**agreed, 'model': simulator.model}

    def differences(self, snapshot: bytes | str) -> str:
        """
        Say in what the site of a snapshot differs, empty if in nothing.

        A `StateError` for what is no snapshot.
        """
        theirs, mine = _object(snapshot), self._identity()
        if not {'state', 'run', *mine} <= set(theirs):
            raise StateError('an object without the parts of a snapshot')
        different = [
            f'{key} {str(theirs[key])[:60]!r}, not {own!r}'
            for key, own in mine.items()
            if theirs[key] != own
        ]
        return '; '.join(different)

    def add_wind(
        self, stamp: int, vector: tuple[float, float, float], arrival: int | None = None
    ) -> GoodWind | None:
        """
        Take a sample of a time [ns], blowing to, in [m/s], that arrived at a time [ns].

        Returns the good one; None if the gate refuses it, and counts it.
        """
        with self._lock:
            good = self.run.offer(stamp, vector, arrival, lead=LARGEST_LEAD)
            if good is not None:
                self._has_wind = True
                self.run.advance(good.time, may_join=False)
            return good

    def hold_wind(self, now: int) -> None:
        """Go on with the last wind where the newest sample is older than `PATIENCE` at a time."""
        with self._lock:
            if self._has_wind:
                self.run.advance(now - round(PATIENCE * _SECOND), may_join=False)

    def snapshot(self) -> str:
        """Identity, state and wind, as JSON; empty before the first step."""
        with self._lock:
            if self.run.time is None:
                return ''
            state = base64.b64encode(self.simulator.state().to_bytes()).decode()
            return json.dumps({**self._identity(), 'state': state, 'run': self.run.memory()})

    def join(self, snapshot: bytes | str, now: int) -> None:
        """
        Go on from where another site is at a time [ns] of one's own clock.

        A `StateError` for no snapshot, another tree's, or that of another time.
        """
        content = _object(snapshot)
        try:
            state = TreeState.from_bytes(base64.b64decode(content['state'], validate=True))
            time, origin, wind, samples = content['run']
            waiting = [(int(stamp), [*map(float, velocity)]) for stamp, velocity in samples]
            late = max(abs(int(stamp) - now) for stamp in (time, *(each[0] for each in waiting)))
            is_sound = all(is_wind(*velocity) for _, velocity in waiting)
            is_sound &= 0 <= int(time) - int(origin) < 2 * 10_000 * _SECOND
        except (ValueError, KeyError, TypeError, OverflowError) as error:
            raise StateError(f'a snapshot that cannot be read ({str(error)[:60]})') from error
        if late > _OLDEST_SNAPSHOT or not is_sound:
            raise StateError(
                'a snapshot of another time, or of a wind that cannot be',
                where=self.simulator.tree.name,
                cure='set the clocks of both sites by NTP',
            )
        with self._lock:
            before = self.simulator.state()
            self.simulator.set_state(state)
            try:
                self.run.recall(int(time), int(origin), wind, waiting)
            except TreeSwayError as error:
                self.simulator.set_state(before)
                raise StateError(f'a snapshot that cannot be read ({error})') from error
            self._has_wind = True


def _object(text: bytes | str) -> dict[str, Any]:
    """Return an object of JSON; a `StateError` for anything else."""
    try:
        found = json.loads(text) if len(text) <= _LARGEST else None
    except (ValueError, RecursionError) as error:
        raise StateError(f'{len(text)} bytes that are no JSON') from error
    if not isinstance(found, dict):
        raise StateError(f'{len(text)} bytes that are no object of JSON')
    return found
