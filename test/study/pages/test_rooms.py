# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The drawing of the rooms: from the imports, without a circle, in an order of storeys."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

import pytest

from tree_sway_ros.study.pages.rooms import room_imports, rooms_drawing, storeys, without_shortcuts

HOUSE = {'top': {'middle', 'cellar'}, 'middle': {'cellar'}, 'cellar': set(), 'shed': {'cellar'}}


def test_rooms_and_arrows_are_those_of_the_source(tmp_path: Path) -> None:
    package = tmp_path / 'tree_sway_ros'
    for name, text in {
        '__init__.py': 'import tree_sway_ros.errors',
        'errors.py': 'import os',
        'core/__init__.py': '',
        'core/arrays.py': 'import numpy',
        'core/wind/gate.py': 'from tree_sway_ros.core.arrays import Floats',
        'files/winds.py': 'from tree_sway_ros.core.wind import gate\nimport tree_sway_ros.errors',
    }.items():
        path = package / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    assert room_imports(package) == {
        'errors': set(),
        'core/arrays': set(),
        'core/wind': {'core/arrays'},
        'files': {'core/wind', 'errors'},
    }


def test_the_house_has_no_circle_and_the_core_stands_on_its_own() -> None:
    rooms = room_imports()
    assert len(rooms) > 20
    heights = storeys(rooms)
    assert heights['errors'] == heights['core/arrays'] == 0
    for room, others in rooms.items():
        assert all(heights[other] < heights[room] for other in others)
        if room.startswith('core/'):
            assert all(o.startswith('core/') or o in ('errors', 'kernel_cache') for o in others)


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
