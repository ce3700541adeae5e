# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The drawing of the three packages: every room and the arrows of its imports, from the source.

Layers stand above each other as deep as imports go. An arrow that follows from two others is left
out, so that the drawing shows the essential ones.

"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
PACKAGES = {'tree_sway': '', 'tree_sway_ros': 'ros/', 'lab/tree_sway_lab': 'lab'}
"""Folder of each package, and what its rooms are called by: the laboratory is one room."""

_WIDTH, _ROW, _BOX, _HEIGHT, _MARGIN = 1180, 78, 30, 14, 26
_COLOURS = {'core': '#dcebdc', 'ros': '#fbe9d3', 'lab': '#eee6f4', 'other': '#e3ebf5'}

Rooms = dict[str, set[str]]


def room_imports(root: Path = ROOT) -> Rooms:
    """
    Rooms and what each of them imports, of the source as it is.

    Parameters
    ----------
    root
        Folder of the packages.

    Returns
    -------
    dict
        For each room the rooms it imports: ``core/wind``, ``files``, ``ros/nodes``, ``lab``.

    """
    found: Rooms = {}
    for folder in PACKAGES:
        package = root / folder
        for path in sorted(package.rglob('*.py')):
            own = _room((package.name, *path.relative_to(package).with_suffix('').parts))
            others = {_room(module) for module in _imports(path)}
            if own:
                found.setdefault(own, set()).update(others - {own, ''})
    return {room: others & found.keys() for room, others in found.items()}


def _room(module: tuple[str, ...]) -> str:
    """Name of the room a module belongs to; empty for a package as a whole and for others'."""
    prefixes = {Path(folder).name: prefix for folder, prefix in PACKAGES.items()}
    prefix, parts = prefixes.get(module[0]), module[1:]
    if prefix is None or parts in ((), ('__init__',), ('__main__',)):
        return ''
    if prefix == 'lab':
        return prefix
    if parts[0] != 'core' and parts[1:2] == ('commands',):
        return f'{prefix}{parts[0]}/commands'
    if parts[0] != 'core' or prefix:
        return prefix + parts[0]
    return f'core/{parts[1]}' if len(parts) > 1 and parts[1] != '__init__' else ''


def _imports(path: Path) -> Iterator[tuple[str, ...]]:
    """Modules that a file imports, as their parts."""
    for node in ast.walk(ast.parse(path.read_text(encoding='utf-8'))):
        names: list[str] = []
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node.module:
            names = [f'{node.module}.{alias.name}' for alias in node.names]
        yield from (tuple(name.split('.')) for name in names)


def storeys(rooms: Rooms) -> dict[str, int]:
    """
    Height of each room over the ground: one above the highest room that it imports.

    Raises
    ------
    RecursionError
        If rooms import each other in a circle.

    """
    heights: dict[str, int] = {}

    def height(room: str) -> int:
        if room not in heights:
            heights[room] = 1 + max((height(other) for other in rooms.get(room, ())), default=-1)
        return heights[room]

    for room in rooms:
        height(room)
    return heights


def without_shortcuts(rooms: Rooms) -> Rooms:
    """Leave out every arrow that follows from two others."""
    below: Rooms = {}

    def reached(room: str) -> set[str]:
        if room not in below:
            own = rooms.get(room, set())
            below[room] = own.union(*(reached(other) for other in own))
        return below[room]

    return {
        room: {o for o in others if not any(o in reached(via) for via in others - {o})}
        for room, others in rooms.items()
    }


def rooms_drawing(rooms: Rooms | None = None) -> str:
    """Draw the rooms and the arrows of their imports as SVG; those of the source if None."""
    rooms = room_imports() if rooms is None else rooms
    arrows, level = without_shortcuts(rooms), storeys(rooms)
    top = max(level.values())
    places: dict[str, tuple[float, float, float]] = {}
    for storey in range(top + 1):
        names = _ordered([name for name in level if level[name] == storey], arrows, places)
        sizes = [16.0 + 8.2 * len(name) for name in names]
        gap = (_WIDTH - 2 * _MARGIN - sum(sizes)) / (len(names) + 1)
        x = _MARGIN + gap
        for name, size in zip(names, sizes, strict=True):
            places[name] = (x + size / 2, _MARGIN + (top - storey) * _ROW + _BOX / 2, size)
            x += size + gap
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {_WIDTH} '
        f'{2 * _MARGIN + top * _ROW + _BOX}" font-family="sans-serif" font-size="{_HEIGHT}">',
        '<title>Rooms of the three packages, and what they import</title>',
        '<defs><marker id="tip" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="7" '
        'markerHeight="7" orient="auto"><path d="M0 0 8 4 0 8z" fill="#777"/></marker></defs>',
        '<rect width="100%" height="100%" fill="white"/>',
    ]
    for name in sorted(arrows):
        lines += [_arrow(places[name], places[other]) for other in sorted(arrows[name])]
    lines += [_box(name, places[name]) for name in sorted(places)]
    return '\n'.join([*lines, '</svg>', ''])


def _ordered(
    names: list[str], arrows: Rooms, places: dict[str, tuple[float, float, float]]
) -> list[str]:
    """Put rooms over the middle of what they import, so that few arrows cross."""

    def middle(name: str) -> float:
        under = [places[other][0] for other in arrows.get(name, ()) if other in places]
        return sum(under) / len(under) if under else _WIDTH / 2

    return sorted(names, key=lambda name: (middle(name), name))


def _arrow(upper: tuple[float, float, float], lower: tuple[float, float, float]) -> str:
    (x1, y1, _), (x2, y2, _) = upper, lower
    y1, y2 = y1 + _BOX / 2, y2 - _BOX / 2
    bend = (y2 - y1) / 2
    path = (
        f'M{x1:.0f} {y1:.0f}C{x1:.0f} {y1 + bend:.0f} {x2:.0f} {y2 - bend:.0f} {x2:.0f} {y2:.0f}'
    )
    return f'<path d="{path}" fill="none" stroke="#999" marker-end="url(#tip)"/>'


def _box(name: str, place: tuple[float, float, float]) -> str:
    x, y, width = place
    group = name.split('/')[0]
    colour = _COLOURS.get(group, _COLOURS['other'])
    return (
        f'<g><rect x="{x - width / 2:.0f}" y="{y - _BOX / 2:.0f}" width="{width:.0f}" '
        f'height="{_BOX}" rx="5" fill="{colour}" stroke="#555"/><text x="{x:.0f}" '
        f'y="{y + 5:.0f}" text-anchor="middle">{name}</text></g>'
    )
