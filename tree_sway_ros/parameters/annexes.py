# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Annexes of the solver in installed packages, by the entry point group `tree_sway_ros.solver`.

An entry point names a class, a `SolverAnnex`. The table of its parameters is a file beside its
module: that of ``soil/probe.py`` is ``soil/probe.yaml``, in the form of ``nodes.yaml``.
"""

from __future__ import annotations

from contextlib import suppress
from importlib.metadata import entry_points, EntryPoint
from importlib.util import find_spec
from pathlib import Path

from tree_sway.parameters import read_tables, Table

_GROUP = 'tree_sway_ros.solver'


def _found() -> dict[EntryPoint, Table]:
    """Return what is installed, in the order of the names; without what was taken away since."""
    found = {}
    for point in sorted(entry_points(group=_GROUP), key=lambda each: each.name):
        with suppress(ModuleNotFoundError):
            if (spec := find_spec(point.module)) is not None:
                table = Path(str(spec.origin)).with_suffix('.yaml')
                found[point] = read_tables(table)['solver']
    return found


ANNEXES = _found()
"""Parameters of each annex."""
