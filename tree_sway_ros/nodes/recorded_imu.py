# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Motion sensors of a bag, played between the samples of its wind."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from tree_sway.core.arrays import Floats, Ints
from tree_sway.errors import FormatError
from tree_sway.files.motion import read_imu_bag
from tree_sway_ros.process.topics import refuse_topic_name
from tree_sway_ros.wire.imu_messages import imu_message

_BAGS = ('.db3', '.mcap')
"""Suffixes of files of a bag."""


class JoinedRows(NamedTuple):
    """
    Samples of all sources in the order of their times.

    Parameters
    ----------
    time
        Times in [s], as those of the wind, rising, (n,).
    source
        Number of the motion sensor, -1 for the wind, (n,).
    sample
        Row of the sample in its own record, (n,).

    """

    time: Floats
    source: Ints
    sample: Ints


class RecordedImu:
    """
    Topics of a bag.

    Parameters
    ----------
    file
        The bag.
    topics
        Names of topics, with commas; may be empty.
    epoch
        Date in [s] from which the times of the wind count; None without dates.

    Raises
    ------
    FormatError
        Not a bag, or no such topic.
    ParameterError
        No name of a topic.

    """

    def __init__(self, file: str, topics: str, epoch: float | None) -> None:
        self.topics = [each.strip() for each in topics.split(',') if each.strip()]
        """Names of the topics."""
        for each in self.topics:
            refuse_topic_name(each, 'imu')
        if self.topics and Path(file).is_file() and Path(file).suffix not in _BAGS:
            cure = 'leave imu out, or give a bag with wind and motion'
            raise FormatError('no bag, whose topics imu plays', where=file, cure=cure)
        self._records = [read_imu_bag(Path(file), each) for each in self.topics]
        self._epoch = epoch

    def joined(self, wind: Floats) -> JoinedRows:
        """
        Join the samples with those of the wind at its times in [s], (m,).

        Samples of before the wind and after it are left out.
        """
        rows = [(wind, np.full(len(wind), -1), np.arange(len(wind)))]
        for number, record in enumerate(self._records):
            after = record.times_after(self._epoch)
            kept = np.flatnonzero((after >= wind[0]) & (after <= wind[-1]))
            rows.append((after[kept], np.full(len(kept), number), kept))
        time, source, sample = map(np.concatenate, zip(*rows, strict=True))
        order = np.argsort(time, kind='stable')
        return JoinedRows(time[order], source[order], sample[order])

    def message(self, source: int, sample: int, stamp: int) -> Any:
        """Make the message of a sample with a stamp in [ns]."""
        record = self._records[source]
        parts: list[Sequence[float] | None] = [
            None if values is None else values[sample].tolist()
            for values in (record.acceleration, record.rate, record.orientation)
        ]
        return imu_message(stamp, *parts)
