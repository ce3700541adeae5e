# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A drawing of measured against computed, from the claim ``published``.

Both are on logarithmic axes, with the line on which they agree and the band of a factor of 2.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import NamedTuple

PAGE = Path('doc/proof/published/README.md')

_SIZE, _MARGIN, _PANEL, _HEAD = 300, 60, 390, 44
_FIRST_NUMBER = 5
"""Column of the first number that is compared; before it stand species, sizes, site and source."""
_COLOURS = {'conifer': '#2f7d4f', 'broadleaf': '#b3682a', 'line': '#888'}
_LEGEND = {
    'conifer': 'conifer',
    'broadleaf': 'broadleaf',
    'line': 'a line over D / H^2 (baseline)',
}


class Point(NamedTuple):
    """A measured figure and the computed one."""

    kind: str
    measured: float
    computed: float


class Panel(NamedTuple):
    """One quantity: title, name of the other's figure, range of both axes, and the ticks."""

    title: str
    other: str
    low: float
    high: float
    ticks: tuple[float, ...]


FREQUENCY = Panel('first frequency [Hz]', 'measured', 0.12, 1.4, (0.2, 0.5, 1.0))
MOMENT = Panel(
    'moment at the base [N m], conifers at 10 m/s',
    'fitted to measured',
    800.0,
    60000.0,
    (1e3, 1e4, 5e4),
)


def published_points(page: str) -> tuple[list[Point], list[Point]]:
    """Read the points of frequency and of moment from the text of the page."""
    frequencies, moments = list[Point](), list[Point]()
    for line in page.splitlines():
        cells = [cell.strip() for cell in line.strip('|').split('|')]
        if len(cells) != _FIRST_NUMBER + 5 or not cells[1][:1].isdigit():
            continue
        measured, ours, by_line, published, moment = cells[_FIRST_NUMBER:]
        kind = 'conifer' if moment else 'broadleaf'
        frequencies.append(Point('line', float(measured), float(by_line)))
        if ours[:1].isdigit():  # a tree that could not be grown has no frequency
            frequencies.append(Point(kind, float(measured), float(ours)))
        if moment:
            moments.append(Point(kind, float(published), float(moment)))
    return frequencies, moments


def published_drawing(page: str | None = None) -> str:
    """Draw both quantities as SVG, from the text of the page or from its file."""
    text = PAGE.read_text(encoding='utf-8') if page is None else page
    frequencies, moments = published_points(text)
    width, height = 2 * _PANEL, _HEAD + _SIZE + _MARGIN
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" '
        'font-family="sans-serif" font-size="13">',
        '<title>Measured against computed: frequencies and moments of published trees</title>',
        '<rect width="100%" height="100%" fill="white"/>',
    ]
    x = float(_MARGIN)
    for kind, name in _LEGEND.items():
        lines.append(_mark(kind, x, 16.0))
        lines.append(_text(x + 10.0, 20.0, name, 'start'))
        x += 40.0 + 7.0 * len(name)
    lines += _panel_lines(FREQUENCY, frequencies, _MARGIN)
    lines += _panel_lines(MOMENT, moments, _PANEL + _MARGIN)
    return '\n'.join([*lines, '</svg>', ''])


def _panel_lines(panel: Panel, points: list[Point], left: float) -> list[str]:
    """Draw one quantity, its axes from a left edge on."""
    bottom = _HEAD + _SIZE

    def along(value: float) -> float:
        share = math.log(value / panel.low) / math.log(panel.high / panel.low)
        return _SIZE * min(max(share, 0.0), 1.0)

    def line(factor: float, dash: str) -> str:
        start = max(panel.low, panel.low / factor)
        end = min(panel.high, panel.high / factor)
        return (
            f'<line x1="{left + along(start):.1f}" y1="{bottom - along(factor * start):.1f}" '
            f'x2="{left + along(end):.1f}" y2="{bottom - along(factor * end):.1f}" '
            f'stroke="#999" stroke-dasharray="{dash}"/>'
        )

    middle = left + _SIZE / 2
    lines = [
        f'<rect x="{left}" y="{_HEAD}" width="{_SIZE}" height="{_SIZE}" fill="none" '
        'stroke="#555"/>',
        line(1.0, 'none'),
        line(2.0, '4 4'),
        line(0.5, '4 4'),
        _text(middle, _HEAD - 8, panel.title, 'middle'),
        _text(middle, bottom + 38, panel.other, 'middle'),
        f'<text transform="translate({left - 44} {_HEAD + _SIZE / 2}) rotate(-90)" '
        'text-anchor="middle">computed</text>',
    ]
    for tick in panel.ticks:
        lines.append(_text(left + along(tick), bottom + 18, f'{tick:g}', 'middle'))
        lines.append(_text(left - 6, bottom - along(tick) + 4, f'{tick:g}', 'end'))
    lines += [
        _mark(each.kind, left + along(each.measured), bottom - along(each.computed))
        for each in points
    ]
    return lines


def _mark(kind: str, x: float, y: float) -> str:
    fill = 'none' if kind == 'line' else _COLOURS[kind]
    return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="4" fill="{fill}" stroke="{_COLOURS[kind]}"/>'


def _text(x: float, y: float, text: str, anchor: str) -> str:
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}">{text}</text>'
