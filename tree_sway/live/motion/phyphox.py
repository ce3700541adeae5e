# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A phone with phyphox, whose remote access is on: its samples as they come.

``/config`` tells which buffers the sensors of the opened experiment fill, and ``/get`` gives what
is new in them: ``accX=12.5|acc_time`` are the values where the time is above 12.5 s (phyphox wiki,
"Remote-interface communication"; version 1.1.8 and later). Experiments of acceleration with and
without g, of the gyroscope, and any of one's own with several of them are read. An angular rate is
interpolated to the times of the acceleration.
"""

from __future__ import annotations

import asyncio
from collections import ChainMap
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
import json
import math
from typing import Any

import aiohttp
import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.files import list_of, object_of
from tree_sway.files.wind import number, Refusal
from tree_sway.live.motion.motion_reading import MotionReading
from tree_sway.live.readers.json_path import parse_json, value_at
from tree_sway.live.transports.http_poll import document_of
from tree_sway.live.transports.link import Link
from tree_sway.live.transports.loop_transport import LoopTransport
from tree_sway.live.transports.transport import Message

EXPECTS = 'the remote access of phyphox, with an experiment of acceleration or the gyroscope'
_LARGEST = 4 * 2**20
_TIMEOUT = 5.0
_LOOK_AGAIN = 2.0
"""Time [s] without a new sample after which the newest one is looked for: data may be cleared."""
_WAITING = 2000
_PATIENCE = 3.0
"""Time [s] after which an experiment's sensor without any sample is one that the phone lacks."""
_AHEAD = 2
"""Samples by which a buffer may be longer than another: the phone answers while it fills them."""
_SENSORS = (
    ('acceleration', ('accelerometer', 'linear_acceleration')),
    ('rate', ('gyroscope',)),
)
"""Quantities, and the sources of phyphox that have them, best first."""
_KIND = 'phyphox'


@dataclass
class _Sensor:
    """A sensor of an experiment: the names of its buffers, three axes and the time."""

    quantity: str
    axes: tuple[str, ...]
    time: str
    newest: float = 0.0
    """Time of its newest sample [s]."""
    waiting: Floats = field(default_factory=lambda: np.zeros((0, 4)))
    """Samples that were not read yet: time [s] and three axes, (n, 4)."""
    is_heard: bool = False

    def question(self) -> dict[str, str]:
        """Return what is asked for its new samples."""
        after = f'{self.newest:.9g}'
        return {self.time: after, **{axis: f'{after}|{self.time}' for axis in self.axes}}

    def rows(self, answer: Any) -> Floats | None:
        """
        Return its new samples in an answer, (n, 4); None if its buffers differ in length by many.

        All values of an answer are later than one moment, so buffers agree from their first value
        on.
        """
        columns = [_values(answer, name) for name in (self.time, *self.axes)]
        lengths = [*map(len, columns)]
        if max(lengths) - min(lengths) > _AHEAD:
            return None
        return np.array([*zip(*columns, strict=False)]).reshape(-1, 4)

    def note(self, answer: Any) -> bool:
        """Note the newest time of an answer; whether it has new samples."""
        rows = self.rows(answer)
        times = _values(answer, self.time) if rows is None else rows[:, 0].tolist()
        known = [at for at in times if math.isfinite(at)]
        self.newest = known[-1] if known else self.newest
        return bool(known)


@dataclass
class PhyphoxPhone(LoopTransport):
    """
    Transport of the answers of a phone, and reader of them.

    Parameters
    ----------
    url
        Address that phyphox shows, without a path.
    every
        Time between two questions in [s].

    """

    url: str
    every: float
    _sensors: list[_Sensor] = field(default_factory=list, init=False)
    silence = 10.0

    def __str__(self) -> str:
        """Return its address."""
        return self.url

    async def _work(self, receiver: Link) -> None:
        timeout = aiohttp.ClientTimeout(total=_TIMEOUT)
        # Phones of some versions answer one request for each connection.
        connector = aiohttp.TCPConnector(force_close=True)
        async with aiohttp.ClientSession(timeout=timeout, connector=connector) as session:
            self._sensors = _sensors_of(await self._document(session, '/config', {}))
            receiver.opened()
            loop = asyncio.get_running_loop()
            heard = -math.inf
            while True:
                asked = loop.time()
                if asked - heard > _LOOK_AGAIN:
                    await self._look(session)
                    heard = asked
                question = ChainMap(*(each.question() for each in self._sensors))
                answer = await self._document(session, '/get', question)
                if any([each.note(answer) for each in self._sensors]):
                    heard = asked
                    receiver.deliver(Message(json.dumps(answer).encode(), '/get'))
                await asyncio.sleep(max(self.every - (loop.time() - asked), 0.0))

    async def _look(self, session: aiohttp.ClientSession) -> None:
        """Take the newest sample that is there now as the one to go on from."""
        times = {each.time: '' for each in self._sensors}
        answer = await self._document(session, '/get', times)
        if value_at(answer, 'status', 'measuring') is False:
            raise ConnectionError('the measurement is paused: press play in phyphox')
        for each in self._sensors:
            values = _values(answer, each.time)
            each.newest = values[-1] if values and math.isfinite(values[-1]) else 0.0

    async def _document(
        self, session: aiohttp.ClientSession, path: str, asked: Mapping[str, str]
    ) -> Any:
        try:
            data = await document_of(
                session, f'{self.url}{path}', _LARGEST, ': is it phyphox 1.1.8 or later?',
                params=asked, allow_redirects=False,
            )  # fmt: skip
        except aiohttp.ClientConnectionError:
            raise ConnectionError(
                'no answer: is remote access on in phyphox, its screen lit and the phone in this '
                'network?'
            ) from None
        document = parse_json(data)
        if not isinstance(document, dict):
            raise ConnectionError(f'its answer is no JSON: expected {EXPECTS}')
        return document

    def read(self, message: Message) -> Sequence[MotionReading | Refusal]:
        """Read an answer; samples of the acceleration wait until the rate is known about them."""
        answer = parse_json(message.data)
        found = list[MotionReading | Refusal]()
        for each in self._sensors:
            rows = each.rows(answer)
            if rows is None:
                return [Refusal(_KIND, f'buffers of the {each.quantity} differ in length')]
            good = rows[np.isfinite(rows[:, 0])]
            found += [Refusal(_KIND, 'its time is no number')] * (len(rows) - len(good))
            each.waiting = np.concatenate([each.waiting, good])[-_WAITING:]
            each.is_heard |= len(each.waiting) > 0
        # What sends nothing while another sensor does is one that the phone lacks.
        is_late = max(np.diff(each.waiting[:, 0]).sum() for each in self._sensors) > _PATIENCE
        first, *others = (each for each in self._sensors if each.is_heard or not is_late)
        if others:
            return found + _joined(first, others[0])
        samples = first.waiting.tolist()
        first.waiting = first.waiting[:0]
        return found + [MotionReading(at, **{first.quantity: (*axes,)}) for at, *axes in samples]


def _joined(force: _Sensor, rate: _Sensor) -> list[MotionReading]:
    """Read accelerations with the rate at their times, up to the newest rate."""
    samples, times = force.waiting, rate.waiting[:, 0]
    if not len(times):
        return []
    is_due = samples[:, 0] <= times[-1]
    force.waiting = samples[~is_due]
    samples = samples[is_due & (samples[:, 0] >= times[0])]
    rates = [np.interp(samples[:, 0], times, axis).tolist() for axis in rate.waiting[:, 1:].T]
    turns = zip(*rates, strict=True)
    both = zip(samples.tolist(), turns, strict=True)
    return [MotionReading(at, (*axes,), turn) for (at, *axes), turn in both]


def _sensors_of(config: Any) -> list[_Sensor]:
    """Return the sensors of an experiment by ``/config``; a `ConnectionError` without any."""
    sources = dict[str, Mapping[str, Any]]()
    for each in map(object_of, list_of(value_at(config, 'inputs'))):
        named = ChainMap(*map(object_of, list_of(each.get('outputs'))))
        if {'x', 'y', 'z', 't'} <= named.keys():
            sources.setdefault(str(each.get('source')), named)
    found = []
    for quantity, kinds in _SENSORS:
        if source := next(filter(sources.get, kinds), None):
            *axes, time = (str(sources[source][name]) for name in 'xyzt')
            found.append(_Sensor(quantity, tuple(axes), time))
    if not found:
        title = str(object_of(config).get('title', ''))[:40]
        raise ConnectionError(
            f"experiment '{title}' has neither acceleration nor gyroscope: open "
            "'Acceleration (with g)' in phyphox, or one of your own with both"
        )
    return found


def _values(answer: Any, name: str) -> list[float]:
    """Return the values of a buffer in an answer, not a number where there is none."""
    known = map(number, list_of(value_at(answer, 'buffer', name, 'buffer')))
    return [math.nan if each is None else each for each in known]
