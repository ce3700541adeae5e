# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Digitised trees in MTG files in the code FORM-A (Godin & Caraglio 1998).

Each line of the section MTG has a vertex, in the column of its depth, and the values of its
features. ``/`` decomposes, ``<`` continues, ``+`` branches, and ``E1<<E35`` leaves out those
between; with ``^`` before, it refers to the vertex above in its own column, else to the latest in
the column before.

Positions ``XX YY ZZ`` are those of the upper end of a vertex, in centimetres, and ``TopDia`` its
diameter there in millimetres, as in AMAPmod's digitising; ``length_unit`` and ``diameter_unit``
change that. A vertex of a coarser scale, such as an axis, has the position of its base. A segment
goes from the vertex before, or from the base of its axis, to each vertex of the finest scales.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
import re
from typing import Any

import numpy as np

from tree_sway.errors import FormatError, TreeError
from tree_sway.files.file_format import contains, FileFormat
from tree_sway.files.table_file import filled_lines
from tree_sway.files.text_file import finite, read_lines
from tree_sway.files.trees.cylinders.cylinders import Cylinders, Trees

_POSITION = ('XX', 'YY', 'ZZ')
_DIAMETER = 'TopDia'
_CODE = re.compile(r'([/<+])([A-Za-z]\w*)(?=[/<+]|$)', re.ASCII)


@dataclass(slots=True, eq=False)
class _Vertex:
    """A vertex on its scale, and its ``edge`` to the one before."""

    label: str
    scale: int
    edge: str
    whole: _Vertex | None
    """Vertex of the coarser scale that it is a part of."""
    parent: _Vertex | None
    position: list[Any] | None = None
    diameter: float = 0.0
    """Its own diameter, or its parent's where it has none."""
    place: _Vertex | None = None
    """Vertex at whose position its successors begin."""
    segment: int = -1
    """Segment that its successors are on."""


def _read(path: Path) -> Trees:
    """Segments of a digitised tree, which are of the finest scale that has positions."""
    vertices = _parse(read_lines(path), str(path))
    placed = [vertex for vertex in vertices if vertex.position]
    finest = max((vertex.scale for vertex in placed), default=0)
    segments: list[tuple[_Vertex, _Vertex, int, bool]] = []
    for vertex in vertices:
        before = _before(vertex)
        parent = vertex.parent
        vertex.place = vertex if vertex.position else before
        if parent is not None:
            vertex.segment = parent.segment
            vertex.diameter = vertex.diameter or parent.diameter
        # Without anything before it, it is the first point of a plant.
        if vertex.scale == finest and vertex.position and before is not None:
            continues = vertex.edge == '<' and before is parent and vertex.segment >= 0
            segments.append((before, vertex, vertex.segment, continues))
            vertex.segment = len(segments) - 1
    if not segments:
        raise FormatError(f'no two vertices with {", ".join(_POSITION)}', cure='digitise the tree')
    bases, tips, parents, continues_parent = zip(*segments, strict=True)
    start, end = np.array([[each.position for each in nodes] for nodes in (bases, tips)])
    diameter = np.array([[each.diameter for each in nodes] for nodes in (bases, tips)]).T
    note = (
        f'{len(placed)} vertices with a position, {len(vertices) - len(placed)} without; '
        f'{len(tips)} of them segments'
    )
    cylinders = Cylinders(
        start,
        end,
        np.where(diameter > 0.0, diameter, diameter[:, 1:]),
        np.array(parents),
        np.array(continues_parent),
        [each.label for each in tips],
        notes=(note,),
    )
    return (cylinders,)


def _before(vertex: _Vertex) -> _Vertex | None:
    """
    Vertex at whose position another one begins, None without one.

    It is the base of the axis whose first part it is, if that has a position; else the place of
    its parent.
    """
    axis = vertex
    while axis.edge == '/' and axis.whole is not None:
        axis = axis.whole
        if axis.position:
            return axis
    return None if vertex.parent is None else vertex.parent.place


def _parse(lines: list[str], source: str) -> list[_Vertex]:
    """Parse the vertices of an MTG file."""
    scales = _scales(lines)
    heads = ('ENTITY-CODE', 'TOPO')  # the second in older files
    begin = next((i for i, line in enumerate(lines) if line.startswith(heads)), None)
    if begin is None:
        raise FormatError('no line ENTITY-CODE', cure='save it as FORM-A')
    header = [cell.strip() for cell in lines[begin].split('\t')]
    first = next((i for i, cell in enumerate(header) if i and cell), len(header))
    if _DIAMETER not in header:
        raise FormatError(
            f'no feature {_DIAMETER} among {", ".join(header[first:])}',
            cure=f'call the diameter [mm] {_DIAMETER}',
        )
    vertices: list[_Vertex] = []
    latest: list[_Vertex] = []
    """Latest vertex of each column."""
    for number, line in zip(*filled_lines(lines[begin + 1 :]), strict=True):
        where = f'{source}:{begin + 1 + number}'
        cells = line.rstrip().split('\t')
        column = next((i for i, cell in enumerate(cells[:first]) if cell.strip()), None)
        if column is None:
            raise FormatError(f'no code in the first {first} columns', where=where)
        code = cells[column].strip().replace('<<', '<').replace('++', '+')
        above = column if code.startswith('^') else column - 1
        if above >= len(latest):
            raise TreeError(f"'{code[:20]}' has no parent", where=where, cure='check its column')
        reference = latest[above] if above >= 0 else None
        added = _vertices(code.removeprefix('^'), reference, scales, where)
        vertices += added
        latest[column:] = added[-1:]
        values = dict(zip(header[first:], map(finite, cells[first:]), strict=False))
        position = [values.get(name) for name in _POSITION]
        added[-1].position = None if None in position else position
        added[-1].diameter = max(values.get(_DIAMETER) or 0.0, 0.0)
    if not vertices:
        raise FormatError('no vertices')
    return vertices


def _scales(lines: list[str]) -> dict[str, int]:
    """Scale of each class, from the section CLASSES."""
    code = next((line.partition(':')[2].strip() for line in lines if line.startswith('CODE')), '')
    if not code.startswith('FORM-A'):
        raise FormatError(f"the code is '{code[:20]}', not FORM-A")
    begin = next((i for i, line in enumerate(lines) if line.startswith('SYMBOL')), len(lines))
    scales: dict[str, int] = {}
    for line in lines[begin + 1 :]:
        cells = line.split()
        scale = finite(cells[1]) if len(cells) > 1 else None
        if scale is None:
            break
        scales[cells[0]] = int(scale)
    if not scales:
        raise FormatError('no CLASSES with SYMBOL and SCALE')
    return scales


def _vertices(
    code: str, reference: _Vertex | None, scales: dict[str, int], where: str
) -> list[_Vertex]:
    """Return the vertices of a code, such as ``/P1/A1``, of which each refers to the last."""
    parts = _CODE.findall(code)
    if not parts or ''.join(map(''.join, parts)) != code:
        raise FormatError(
            f"'{code[:20]}' is not a code", where=where, cure='such as /P1, <S2 or +A1'
        )
    found: list[_Vertex] = []
    for edge, name in parts:
        symbol = name.rstrip('0123456789')
        if symbol not in scales:
            raise FormatError(f"no class '{symbol}'", where=where, cure='list it under CLASSES')
        reference = _vertex(f'{where}: {name}', scales[symbol], edge, reference)
        found.append(reference)
    return found


def _vertex(label: str, scale: int, edge: str, reference: _Vertex | None) -> _Vertex:
    """Make the vertex that an edge joins to another one."""
    if edge == '/':
        above = 0 if reference is None else reference.scale
        if scale != above + 1:
            raise TreeError(f'scale {scale} in scale {above}', where=label)
        # The first part of a branch has the place of its branch.
        parent = None if reference is None else reference.parent
        return _Vertex(label, scale, edge, reference, parent)
    while reference is not None and reference.scale < scale:
        reference = reference.parent  # below the branch of a vertex that goes on
    before = reference
    while before is not None and before.scale > scale:
        before = before.whole
    if before is None or before.scale != scale:
        raise TreeError(f"'{edge}' has nothing of scale {scale} before it", where=label)
    return _Vertex(label, scale, edge, before.whole, reference)


_UNITS = {'length_unit': 0.01, 'diameter_unit': 0.001}
FORMAT = FileFormat('mtg', ('.mtg',), contains(r'(?:^|\r)CODE.*FORM-'), _read, _UNITS)
