# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Statistics of a stream as text: one line on the present, several on the whole."""

from __future__ import annotations

import math

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway_ros.commands.totals import StreamTotals

_COMPASS = ('E', 'NE', 'N', 'NW', 'W', 'SW', 'S', 'SE')


def status_line(recent: StreamTotals, elapsed: float) -> str:
    """Return one line on the last messages of a stream."""
    wind = 'no wind'
    if recent.wind.count:
        origin = _from(recent.wind.mean)
        rate = recent.wind.rate
        wind = f'wind {recent.wind.length:4.1f} m/s {origin:>7} at {rate:4.1f} Hz'
    tip = f' tip {1e3 * recent.poses.length:6.1f} mm |' if recent.poses.largest else ''
    half, most = recent.latency(0.5, 0.95)
    late = f'{1e3 * half:.2f} ms (p95 {1e3 * most:.2f})'
    line = f'{elapsed:6.1f} s | {wind} |{tip} poses {recent.poses.rate:5.1f} Hz, latency {late}'
    return f'{line} | {_foreign(recent)}' if recent.foreign else line


def summary(totals: StreamTotals, rate: float) -> str:
    """Return several lines on a whole stream; `rate` is its expected rate in [Hz]."""
    poses = totals.poses
    wind = totals.wind
    if not poses.count:
        return 'no poses'
    late = [1e3 * each for each in totals.latency(0.5, 0.95, 1.0)]
    lines = [
        f'poses    {poses.count} at {poses.rate:.2f} Hz (wanted {rate:g}), '
        f'{totals.missing(rate) or "none"} missing',
        f'latency  p50 {late[0]:.2f}, p95 {late[1]:.2f}, max {late[2]:.2f} ms',
    ]
    if wind.count:
        lines.append(
            f'wind     {wind.count} at {wind.rate:.2f} Hz, mean {wind.length:.2f}, '
            f'max {wind.largest:.2f} m/s, {_from(wind.mean)}'
        )
    if poses.largest:
        east, north, up = 1e3 * poses.mean
        mean = 1e3 * poses.length
        most = 1e3 * poses.largest
        lines.append(
            f'tip      {mean:.1f} mm from rest on average, {most:.1f} at most; '
            f'mean {east:+.1f} east, {north:+.1f} north, {up:+.1f} up'
        )
    if totals.foreign:
        lines.append(f'ignored  {_foreign(totals)}')
    return '\n'.join(lines)


def _foreign(totals: StreamTotals) -> str:
    return f'{totals.foreign} pose arrays of another program'


def _from(vector: Floats) -> str:
    """Direction that the wind comes from, as text."""
    if float(np.linalg.norm(vector)) < 0.05:
        return 'calm'
    octant = round(math.atan2(-vector[1], -vector[0]) / (math.pi / 4.0)) % 8
    return f'from {_COMPASS[octant]}'
