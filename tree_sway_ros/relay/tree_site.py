# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A site: a tree that is solved on a grid of absolute time, as far as its wind is known.

Sites that have the same samples take the same steps and agree bit for bit, whenever the samples
come. One that joins later sets a snapshot of another, or waits until damping has made them alike.
"""

from __future__ import annotations

import base64
from collections import deque
from collections.abc import Callable
import json
import threading

import numpy as np
from numpy.typing import ArrayLike

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.core.simulator.protocol import TreeSimulator
from tree_sway_ros.core.state.tree_state import TreeState
from tree_sway_ros.errors import StateError

PATIENCE = 1.0
"""The last wind is held once it is so old [s]."""

_SECOND = 1_000_000_000


class Site:
    """
    Steps a tree along samples of wind, at a whole rate [Hz] that all sites have, from any thread.

    ``stepped`` is called after each step with its end [ns] and its mean wind [m/s].
    """

    def __init__(
        self,
        simulator: TreeSimulator,
        rate: int = 60,
        stepped: Callable[[int, Floats], None] = lambda stamp, wind: None,
    ) -> None:
        self.simulator, self.rate = simulator, rate
        self._stepped = stepped
        self._samples: deque[tuple[int, Floats]] = deque()
        self._index: int | None = None
        self._lock = threading.RLock()
        self.n_joined = 0
        """Snapshots that were set."""

    def identity(self) -> str:
        """Return what sites must agree in, as JSON."""
        simulator = self.simulator
        told = {'tree': simulator.tree.name, 'digest': simulator.digest(), 'rate': self.rate}
        return json.dumps({**told, 'model': simulator.model})

    def check(self, identity: str) -> None:
        """Raise a `StateError` if another site has another tree, model, settings or rate."""
        theirs, own = json.loads(identity), json.loads(self.identity())
        different = [f'{key} {theirs.get(key)}, not {own[key]}' for key in own
                     if theirs.get(key) != own[key]]  # fmt: skip
        if different:
            raise StateError(
                f'the other site has {"; ".join(different)}',
                where=self.simulator.tree.name,
                cure='open the same tree with the same settings and release at both sites',
            )

    def add_wind(self, stamp: int, vector: ArrayLike) -> None:
        """Take a sample of a time [ns], blowing to, in [m/s]; one that is not newer is dropped."""
        with self._lock:
            if not self._samples or stamp > self._samples[-1][0]:
                self._samples.append((stamp, np.array(vector, dtype=np.float64)))
            self._advance(self._samples[-1][0])

    def hold_wind(self, now: int) -> None:
        """Go on with the last wind where the newest sample is older than `PATIENCE` at a time."""
        with self._lock:
            self._advance(now - round(PATIENCE * _SECOND))

    def snapshot(self) -> str:
        """State, and the wind from its time on, as JSON; empty before the first step."""
        with self._lock:
            if self._index is None:
                return ''
            state = base64.b64encode(self.simulator.state().to_bytes()).decode()
            wind = [[stamp, *vector.tolist()] for stamp, vector in self._samples]
            return json.dumps({'step': self._index, 'wind': wind, 'state': state})

    def join(self, snapshot: str) -> None:
        """Go on from where another site is; a `StateError` for none, or another tree's."""
        try:
            told = json.loads(snapshot)
            state = TreeState.from_bytes(base64.b64decode(told['state']))
            index, wind = int(told['step']), np.array(told['wind'], dtype=object).reshape(-1, 4)
        except (ValueError, KeyError, TypeError) as error:
            raise StateError(f'a snapshot that cannot be read ({error})') from error
        with self._lock:
            self.simulator.set_state(state)
            own = [each for each in self._samples if not len(wind) or each[0] > wind[-1][0]]
            theirs = [(int(row[0]), np.array(row[1:], dtype=np.float64)) for row in wind]
            self._samples = deque([*theirs, *own])
            self._index, self.n_joined = index, self.n_joined + 1
            if self._samples:
                self._advance(self._samples[-1][0])

    def _advance(self, until: int) -> None:
        """Take every step that ends by a time [ns]."""
        samples, rate = self._samples, self.rate
        if self._index is None:
            self._index = -(-samples[0][0] * rate // _SECOND) if samples else None
        while self._index is not None and (end := (self._index + 1) * _SECOND // rate) <= until:
            start = self._index * _SECOND // rate
            wind = self._mean(start, end)
            self.simulator.step(wind, 1.0 / rate)
            self._index += 1
            while len(samples) > 1 and samples[1][0] <= end:
                samples.popleft()
            self._stepped(end, wind)

    def _mean(self, start: int, end: int) -> Floats:
        """Mean over a step of straight lines between the samples, held before and after them."""
        stamps = np.array([stamp - start for stamp, _ in self._samples], dtype=np.float64)
        values = np.array([vector for _, vector in self._samples])
        inside = stamps[(stamps > 0) & (stamps < end - start)]
        knots = np.concatenate(([0.0], inside, [end - start]))
        at = np.array([np.interp(knots, stamps, column) for column in values.T])
        areas = 0.5 * (at[:, 1:] + at[:, :-1]) * np.diff(knots)
        return np.asarray(areas.sum(axis=1) / (end - start))
