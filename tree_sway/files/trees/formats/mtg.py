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

from collections.abc import Sequence
from dataclasses import dataclass, field
import math
from pathlib import Path
import re
from typing import NamedTuple

import numpy as np

from tree_sway.errors import FormatError, TreeError
from tree_sway.files.file_format import contains, FileFormat
from tree_sway.files.text_file import finite, read_lines
from tree_sway.files.trees.cylinders.cylinders import Cylinders

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
    features: dict[str, float] = field(default_factory=dict)
    diameter: float = 0.0
    """Its own diameter, or its parent's where it has none."""
    place: _Vertex | None = None
    """Vertex at whose position its successors begin."""
    segment: int = -1
    """Segment that its successors are on."""

    @property
    def position(self) -> list[float]:
        return [self.features.get(name, math.nan) for name in _POSITION]

    @property
    def is_placed(self) -> bool:
        return all(name in self.features for name in _POSITION)

    @property
    def begins(self) -> _Vertex | None:
        """Vertex whose first part it is."""
        return self.whole if self.edge == '/' else None


class _Segment(NamedTuple):
    """A segment from one vertex to another, on a parent segment."""

    base: _Vertex
    tip: _Vertex
    parent: int
    continues: bool


def _read(path: Path) -> tuple[Cylinders, ...]:
    """Segments of a digitised tree."""
    vertices = _parse(read_lines(path), str(path))
    segments = _segments(vertices)
    if not segments:
        raise FormatError(f'no two vertices with {", ".join(_POSITION)}', cure='digitise the tree')
    known = list(dict.fromkeys(name for each in vertices for name in each.features))
    if _DIAMETER not in known:
        raise FormatError(
            f'no feature {_DIAMETER} among {", ".join(known)}',
            cure=f'call the diameter [mm] {_DIAMETER}',
        )
    ends = [(each.base.diameter, each.tip.diameter) for each in segments]
    diameter = np.array([(base if base > 0.0 else tip, tip) for base, tip in ends])
    n_placed = sum(vertex.is_placed for vertex in vertices)
    note = (
        f'{n_placed} vertices with a position, {len(vertices) - n_placed} without; '
        f'{len(segments)} of them segments'
    )
    cylinders = Cylinders(
        np.array([each.base.position for each in segments]),
        np.array([each.tip.position for each in segments]),
        diameter,
        np.array([each.parent for each in segments], dtype=np.int64),
        np.array([each.continues for each in segments], dtype=np.bool_),
        [each.tip.label for each in segments],
        notes=(note,),
    )
    return (cylinders,)


def _segments(vertices: Sequence[_Vertex]) -> list[_Segment]:
    """Find the segments, which are of the finest scale that has positions."""
    finest = max((vertex.scale for vertex in vertices if vertex.is_placed), default=0)
    segments: list[_Segment] = []
    for vertex in vertices:
        before = _before(vertex)
        parent = vertex.parent
        vertex.place = vertex if vertex.is_placed else before
        vertex.diameter = vertex.features.get(_DIAMETER, 0.0)
        if parent is not None:
            vertex.segment = parent.segment
            if vertex.diameter <= 0.0:
                vertex.diameter = parent.diameter
        if vertex.scale != finest or not vertex.is_placed or before is None:
            continue  # without anything before it, it is the first point of a plant
        continues = vertex.edge == '<' and before is parent and vertex.segment >= 0
        segments.append(_Segment(before, vertex, vertex.segment, continues))
        vertex.segment = len(segments) - 1
    return segments


def _before(vertex: _Vertex) -> _Vertex | None:
    """
    Vertex at whose position another one begins, None without one.

    It is the base of the axis whose first part it is, if that has a position; else the place of
    its parent.
    """
    axis = vertex.begins
    while axis is not None:
        if axis.is_placed:
            return axis
        axis = axis.begins
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
    vertices: list[_Vertex] = []
    latest: list[_Vertex] = []
    """Latest vertex of each column."""
    for number, line in enumerate(lines[begin + 1 :], start=begin + 2):
        if not line.strip() or line.startswith('#'):
            continue
        where = f'{source}:{number}'
        cells = line.rstrip().split('\t')
        column = next((i for i, cell in enumerate(cells[:first]) if cell.strip()), None)
        if column is None:
            raise FormatError(f'no code in the first {first} columns', where=where)
        code = cells[column].strip().replace('<<', '<').replace('++', '+')
        reference = _reference(latest, column, code, where)
        added = _vertices(code.removeprefix('^'), reference, scales, where)
        vertices += added
        latest[column:] = added[-1:]
        for name, cell in zip(header[first:], cells[first:], strict=False):
            value = finite(cell)
            if value is not None:
                added[-1].features[name] = value
    if not vertices:
        raise FormatError('no vertices')
    return vertices


def _reference(latest: Sequence[_Vertex], column: int, code: str, where: str) -> _Vertex | None:
    """Vertex that a code in a column refers to, None for a code that begins a plant."""
    above = column if code.startswith('^') else column - 1
    if above >= len(latest):
        raise TreeError(f"'{code[:20]}' has no parent", where=where, cure='check its column')
    return latest[above] if above >= 0 else None


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
    parts = list(_CODE.finditer(code))
    if not parts or ''.join(part[0] for part in parts) != code:
        raise FormatError(
            f"'{code[:20]}' is not a code", where=where, cure='such as /P1, <S2 or +A1'
        )
    found: list[_Vertex] = []
    for edge, name in map(re.Match.groups, parts):
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
