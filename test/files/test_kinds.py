# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A file of one kind where another is expected is named, with what takes it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tree_sway.errors import FormatError
from tree_sway.files.motion import read_motion
from tree_sway.files.trees import open_scene, open_tree
from tree_sway.files.wind import read_wind
from tree_sway.forest.plan import read_study

FILES = {
    'wind.csv': 'time,wind_speed [m/s],direction\n0,3,90\n1,3,90\n',
    'wind.dat': '"TOA5","a","CR1000"\n"TIMESTAMP","Ux","Uy"\n"TS","m/s","m/s"\n"","Smp","Smp"\n'
    '"2024-03-05 14:00:00",1,2\n',
    'wind.json': '{"hourly":{"time":["2024-03-05T14:00"],"wind_speed_10m":[3]}}',
    'wind.txt': 'METAR EDDF 051420Z 24010KT 9999 Q1010\n',
    'motion.csv': 'time,ax,ay,az\n0,0,0,9.81\n0.02,0,0,9.81\n',
    'inventory.csv': 'x,y,species,height,dbh\n0,0,Tilia,12,30\n',
    'tree.swc': '1 1 0 0 0 0.1 -1\n2 1 0 0 2 0.1 1\n',
    'tree.yaml': 'species: oak\nbranches: []\n',
    'study.yaml': 'trees: []\nwinds: []\n',
    'forest.yaml': 'trees:\n- {name: a, tree: benjamina}\n',
}
READERS: dict[str, Callable[..., Any]] = {
    'a tree': open_tree,
    'a list of trees': open_scene,
    'a record of wind': read_wind,
    'a record of motion': read_motion,
    'a study': read_study,
}
TAKEN = {
    'wind': ('a record of wind', '--wind'),
    'motion': ('a record of motion', '--motion'),
    'inventory': ('an inventory of trees', 'tree-sway risk'),
    'tree': ('a tree', 'tree-sway info'),
    'study': ('a study', 'tree-sway study'),
    'forest': ('a list of trees', 'tree-sway info'),
}
SEVERAL = ('inventory', 'forest')
"""Files of trees, of which `open_tree` says how to take one."""


OTHERS = [
    (name, wanted)
    for name in FILES
    for wanted in READERS
    if TAKEN[name.partition('.')[0]][0] != wanted
    and not (name.startswith(('tree', *SEVERAL)) and wanted in ('a tree', 'a list of trees'))
    and not (name.startswith('forest') and wanted == 'a study')  # which lacks its winds
]


@pytest.mark.parametrize(('name', 'wanted'), OTHERS)
def test_a_file_of_another_kind_is_named(tmp_path: Path, name: str, wanted: str) -> None:
    path = tmp_path / name
    path.write_text(FILES[name])
    kind, taken = TAKEN[path.stem]
    with pytest.raises(FormatError) as error:
        READERS[wanted](path)
    assert error.value.what.startswith(f'{kind}, not ')
    assert taken in error.value.cure
