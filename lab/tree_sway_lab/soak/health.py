# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What a process takes: memory, handles, threads; and the slope of its memory."""

from __future__ import annotations

import os
from pathlib import Path
from typing import NamedTuple

import numpy as np

_WARM, _WARM_SHARE = 600.0, 0.2
"""Time at the beginning whose growth is start and not leak [s]; its largest share of a run."""
_HOUR = 3600.0


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
