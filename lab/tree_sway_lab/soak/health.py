# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What processes take, over a time: memory, handles, threads; and the slope of the memory."""

from __future__ import annotations

from collections.abc import Mapping
import os
from pathlib import Path
import subprocess
from typing import NamedTuple

import numpy as np

from tree_sway.errors import TransportError

_WARM, _WARM_SHARE = 600.0, 0.2
"""Time at the beginning whose growth is start and not leak [s]; its largest share of a run."""
_HOUR = 3600.0
_LINES = 60


class Health(NamedTuple):
    """Health of a process: time since the start [s], memory [MiB], open handles, threads."""

    time: float
    memory: float
    handles: int
    threads: int


def health(since: float, process: int | str = 'self') -> Health:
    """Look at a process, this one if none is named, a time after the start [s]."""
    where = Path(f'/proc/{process}')
    # Counted page by page; the figure of `status` is some 100 kB off.
    pages = (where / 'smaps_rollup').read_text(encoding='ascii').splitlines()
    memory = next(int(line.split()[1]) for line in pages if line.startswith('Rss:'))
    handles, threads = (len(os.listdir(where / of)) for of in ('fd', 'task'))
    return Health(since, memory / 1024.0, handles, threads)


def growth(seen: list[Health]) -> tuple[float, float]:
    """Slope of the memory after warm-up and its standard error [MiB/h]; NaN below ten looks."""
    table = np.array([(each.time, each.memory) for each in seen])
    if len(table):
        table = table[table[:, 0] >= min(_WARM, _WARM_SHARE * table[-1, 0])]
    if len(table) < 10:
        return float('nan'), float('nan')
    line, covariance = np.polyfit(table[:, 0] / _HOUR, table[:, 1], 1, cov=True)
    return float(line[0]), float(np.sqrt(covariance[0, 0]))


def period_of(seconds: float) -> float:
    """Return the time between two looks [s] in a run of some seconds."""
    return min(60.0, max(0.5, seconds / _LINES))


def check(name: str, process: subprocess.Popen[bytes]) -> None:
    """Raise a `TransportError` for a process that has ended."""
    if process.poll() is not None:
        raise TransportError(f'{name} has ended with {process.returncode}')


def has_grown(seen: Mapping[str, list[Health]], limit: float) -> bool:
    """Print what processes took; whether the memory of one grew by more than a limit [MiB/h]."""
    is_larger = False
    for name, looks in seen.items():
        slope, error = growth(looks)
        is_larger |= slope > limit
        rise = 'too short for a figure'
        if np.isfinite(slope):
            rise = f'{slope:+.3f} +- {error:.3f} MiB/h'
        last = looks[-1]
        print(
            f'memory   {name} {rise} after warm-up, {last.memory:.2f} MiB at the end; '
            f'handles {looks[0].handles} to {last.handles}, threads {last.threads}'
        )
    return is_larger


def line_of(seen: Mapping[str, list[Health]], rate: float) -> str:
    """Return the newest figures as a line, with a rate of poses [Hz]."""
    memories = ', '.join(f'{name} {looks[-1].memory:.2f}' for name, looks in seen.items())
    now = next(iter(seen.values()))[-1].time
    return f'{now:8.1f} s | memory [MiB] {memories} | poses {rate:5.1f} Hz'
