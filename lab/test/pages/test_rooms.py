# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The drawing of the rooms: from the imports, without a circle, in an order of storeys."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

import pytest
from tree_sway_lab.pages.rooms import room_imports, rooms_drawing, storeys, without_shortcuts

BELOW = {'drawn', 'errors', 'faces', 'cache', 'tables', 'installed_models'}
HOUSE = {'top': {'middle', 'cellar'}, 'middle': {'cellar'}, 'cellar': set(), 'shed': {'cellar'}}


def test_rooms_and_arrows_are_those_of_the_source(tmp_path: Path) -> None:
    for name, text in {
        'tree_sway/__init__.py': 'from tree_sway.files import winds',
        'tree_sway/errors.py': 'import os',
        'tree_sway/core/__init__.py': '',
        'tree_sway/core/arrays.py': 'import numpy',
        'tree_sway/core/wind/gate.py': 'from tree_sway.core.arrays import Floats',
        'tree_sway/files/winds.py': 'import tree_sway.errors, tree_sway.core.wind.gate',
        'tree_sway_ros/nodes/solver.py': 'from tree_sway.files import winds',
        'lab/tree_sway_lab/soak/command.py': 'from tree_sway_ros.nodes import solver',
    }.items():
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    assert room_imports(tmp_path) == {
        'errors': set(),
        'core/arrays': set(),
        'core/wind': {'core/arrays'},
        'files': {'core/wind', 'errors'},
        'ros/nodes': {'files'},
        'lab': {'ros/nodes'},
    }


def test_the_house_has_no_circle_and_the_core_imports_no_other_room() -> None:
    rooms = room_imports()
    assert len(rooms) > 20
    heights = storeys(rooms)
    assert heights['errors'] == heights['core/arrays'] == 0
    for room, others in rooms.items():
        assert 'lab' not in others
        if not room.startswith(('ros/', 'lab')):
            assert not any(other.startswith('ros/') for other in others)
        if room.startswith('core/'):
            assert all(o.startswith('core/') or o in BELOW for o in others)


def test_storeys_and_shortcuts() -> None:
    assert storeys(HOUSE) == {'cellar': 0, 'middle': 1, 'top': 2, 'shed': 1}
    assert without_shortcuts(HOUSE)['top'] == {'middle'}


def test_a_circle_is_found() -> None:
    with pytest.raises(RecursionError):
        storeys({'egg': {'hen'}, 'hen': {'egg'}})


def test_the_drawing_has_every_room_and_arrow() -> None:
    drawing = ElementTree.fromstring(rooms_drawing(HOUSE))
    texts = {text.text for text in drawing.iter('{http://www.w3.org/2000/svg}text')}
    assert texts == set(HOUSE)
    arrows = [p for p in drawing.iter('{http://www.w3.org/2000/svg}path') if p.get('marker-end')]
    assert len(arrows) == 3
