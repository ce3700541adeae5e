# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
``tree-sway risk`` timed: the trees of a city, in time and in memory.

Twelve species stand in streets, half of them of the commonest three; heights are those of an
ageing city, 4 to 28 m, and stems have 30 to 70 times less.
"""

from __future__ import annotations

from collections.abc import Sequence
from importlib import import_module
import os
from pathlib import Path
import subprocess
import sys
from tempfile import TemporaryDirectory
import time

import numpy as np

from tree_sway.errors import ParameterError
from tree_sway_lab.bench.measured import Measured

N_TREES = 1_000, 20_000
_SPECIES = ['lime', 'maple', 'plane', 'oak', 'birch', 'horse_chestnut', 'robinia', 'ash', 'cherry',
            'hornbeam', 'pine', 'spruce']  # fmt: skip
_PERIOD = 0.2
"""Interval at which the memory of all processes is added up [s]."""
_PROGRAM = 'from tree_sway.commands.cli import main; raise SystemExit(main())'


def time_risk(sizes: Sequence[int] = N_TREES) -> list[Measured]:
    """
    Run ``tree-sway risk`` on inventories of some sizes, on all cores.

    Returns
    -------
    list of Measured
        Per size, the time from start to end and the CPU time of the command and its workers in
        [s], and their largest memory together in [MB], with pages that they share counted for
        each.

    """
    measured = list[Measured]()
    for n_trees in sizes:
        with TemporaryDirectory() as folder:
            write_city(Path(folder, 'city.csv'), n_trees)
            seconds, cpu_seconds, megabytes = run_risk(Path(folder))
        measured += [
            Measured(f'{n_trees:6,} trees, {os.cpu_count()} cores', seconds, 's'),
            Measured(f'{n_trees:6,} trees, CPU time', cpu_seconds, 's'),
            Measured(f'{n_trees:6,} trees, memory', megabytes, 'MB'),
        ]
    return measured


def write_city(path: Path, n_trees: int) -> None:
    """Write an inventory of a number of street trees."""
    rng = np.random.default_rng(n_trees)
    common = [1.0 / 6.0] * 3 + [0.5 / (len(_SPECIES) - 3)] * (len(_SPECIES) - 3)
    species = rng.choice(_SPECIES, n_trees, p=common)
    height = 4.0 + 24.0 * rng.beta(2.0, 3.0, n_trees)
    diameter = height / rng.uniform(30.0, 70.0, n_trees)
    place = rng.uniform(0.0, 5000.0, (n_trees, 2))
    lines = ['x [m],y [m],species,height [m],dbh [m]']
    for row, name in enumerate(species):
        x, y = place[row]
        lines.append(f'{x:.1f},{y:.1f},{name},{height[row]:.1f},{diameter[row]:.2f}')
    path.write_text('\n'.join(lines) + '\n', encoding='utf-8')


def run_risk(folder: Path) -> tuple[float, float, float]:
    """Return time, CPU time [s] and memory [MB] of ``tree-sway risk city.csv`` in a folder."""
    psutil = import_module('psutil')  # comes with dask
    command = [sys.executable, '-c', _PROGRAM, 'risk', 'city.csv', '-o', 'risk.csv']
    cpu_seconds: dict[int, float] = {}
    largest = 0
    began = time.monotonic()
    with subprocess.Popen(command, cwd=folder, stdout=subprocess.DEVNULL) as process:
        whole = psutil.Process(process.pid)
        while process.poll() is None:
            try:
                processes = [whole, *whole.children(recursive=True)]
                largest = max(largest, sum(each.memory_info().rss for each in processes))
                for each in processes:
                    spent = each.cpu_times()
                    cpu_seconds[each.pid] = spent.user + spent.system
            except psutil.NoSuchProcess:
                continue  # one has ended since it was listed
            time.sleep(_PERIOD)
    if process.returncode != 0:
        raise ParameterError('tree-sway risk ended with an error', where='bench risk')
    return time.monotonic() - began, sum(cpu_seconds.values()), largest / 1e6
