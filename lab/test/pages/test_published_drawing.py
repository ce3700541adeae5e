# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The drawing of measured against computed has the figures of the page."""

from pathlib import Path
from xml.etree import ElementTree

from tree_sway_lab.pages.published_drawing import Point, published_drawing, published_points

ROOT = Path(__file__).resolve().parents[3]

PAGE = """
| species | height [m] | diameter [m] | site | measured by | frequency [Hz] | ours | line | moment [N m] | ours |
|---|---|---|---|---|---|---|---|---|---|
| spruce | 15.24 | 0.2032 | forest | one of 8 | 0.364 | 0.361 | 0.35 | 7042 | 19410 |
| ash | 23.6 | 0.35 | forest | one of 8 | 0.209 | 0.273 | 0.216 |  |  |
| ash | 24.37 | 0.2166 | forest | Wytham | 0.221 | not grown | 0.212 |  |  |
"""  # noqa: E501


def test_points_are_those_of_the_section():
    frequencies, moments = published_points(PAGE)
    assert [each for each in frequencies if each.kind != 'line'] == [
        Point('conifer', 0.364, 0.361),
        Point('broadleaf', 0.209, 0.273),
    ]
    assert [each.computed for each in frequencies if each.kind == 'line'] == [0.35, 0.216, 0.212]
    assert moments == [Point('conifer', 7042.0, 19410.0)]


def test_every_point_of_the_page_is_drawn():
    page = (ROOT / 'doc' / 'proof' / 'published' / 'README.md').read_text(encoding='utf-8')
    count = sum(map(len, published_points(page)))
    assert count > 40
    drawn = ElementTree.fromstring(published_drawing(page))
    marks = drawn.findall('{http://www.w3.org/2000/svg}circle')
    assert len(marks) == count + 3  # and the legend
    assert all(44.0 <= float(mark.get('cy', 0)) <= 344.0 for mark in marks[3:])
