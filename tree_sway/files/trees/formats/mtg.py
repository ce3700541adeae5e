# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Digitised trees in MTG files in the code FORM-A (Godin & Caraglio 1998).

Each line of the section MTG has a vertex, in the column of its depth, and the values of its
features. ``/`` decomposes, ``<`` continues, ``+`` branches; with ``^`` before, it refers to the
vertex above in its own column, else to the latest in the column before.

Positions ``XX YY ZZ`` are those of the upper end of a vertex, in centimetres, and ``TopDia`` its
diameter there in millimetres, as in AMAPmod's digitising; ``length_unit`` and ``diameter_unit``
change that. A vertex of a coarser scale, such as an axis, has the position of its base. A segment
goes from the vertex before, or from the base of its axis, to each vertex of the finest scales.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
import re

import numpy as np

from tree_sway.errors import FormatError, TreeError
from tree_sway.files.file_format import FileFormat
from tree_sway.files.text_file import finite, read_lines
from tree_sway.files.trees.cylinders.cylinders import Cylinders
from tree_sway.files.trees.tree_options import MEASURED

_POSITION = ('XX', 'YY', 'ZZ')
_DIAMETER = 'TopDia'
_CODE = re.compile(r'([/<+])([A-Za-z]\w*)(?=[/<+]|$)', re.ASCII)


@dataclass(slots=True)
class _Vertex:
    """A vertex on its scale, its ``edge`` to the one before, its complex and its parent."""

    label: str
    scale: int
    edge: str
    complex: int  # noqa: A003
    parent: int
    features: dict[str, float] = field(default_factory=dict)


def _is_mtg(head: str) -> bool:
    """Whether the beginning of a file is that of an MTG file."""
    return any(line.startswith('CODE') and 'FORM-' in line for line in head.splitlines())


def _read(path: Path) -> tuple[Cylinders, ...]:
    """Segments of a digitised tree."""
    vertices = _parse(read_lines(path), str(path))
    points = np.array([[v.features.get(name, np.nan) for name in _POSITION] for v in vertices])
    placed = np.isfinite(points).all(axis=1).tolist()
    # Segments are of the finest scale that has positions.
    finest = max((v.scale for v, here in zip(vertices, placed, strict=True) if here), default=0)
    base, tip, parent, continues = list[int](), list[int](), list[int](), list[bool]()
    width, place, carrier = np.zeros(len(vertices)), list[int](), list[int]()
    for index, vertex in enumerate(vertices):
        before = _before(vertices, vertex, placed, place)
        on = carrier[vertex.parent] if vertex.parent >= 0 else -1
        # Successors of a vertex without a position refer to its predecessor.
        own = vertex.features.get(_DIAMETER, 0.0)
        width[index] = own if own > 0.0 or vertex.parent < 0 else width[vertex.parent]
        place.append(index if placed[index] else before)
        carrier.append(on)
        if vertex.scale != finest or not placed[index] or before < 0:
            continue  # without anything before it, it is the first point of a plant
        carrier[index] = len(tip)
        base.append(before)
        tip.append(index)
        parent.append(on)
        continues.append(vertex.edge == '<' and before == vertex.parent and on >= 0)
    if not tip:
        what = f'no two vertices with {", ".join(_POSITION)}'
        raise FormatError(what, where=str(path), cure='digitise the tree')
    at_base = np.where(width[base] > 0.0, width[base], width[tip])
    note = (
        f'{sum(placed)} vertices with a position, {placed.count(False)} without; '
        f'{len(tip)} of them segments'
    )
    cylinders = Cylinders(
        points[base], points[tip], np.stack([at_base, width[tip]], axis=1),
        np.array(parent, dtype=np.int64), np.array(continues, dtype=np.bool_),
        [vertices[index].label for index in tip], notes=(note,),
    )  # fmt: skip
    return (cylinders,)


def _before(vertices: list[_Vertex], vertex: _Vertex, placed: list[bool], place: list[int]) -> int:
    """
    Vertex at whose position another one begins, -1 without one.

    It is the base of the axis whose first part it is, if that has a position; else its parent.
    """
    whole = vertex.complex if vertex.edge == '/' else -1
    while whole >= 0:
        if placed[whole]:
            return whole
        whole = vertices[whole].complex if vertices[whole].edge == '/' else -1
    return place[vertex.parent] if vertex.parent >= 0 else -1


def _parse(lines: list[str], source: str) -> list[_Vertex]:
    """Parse the vertices of an MTG file."""
    scales = _scales(lines, source)
    begin = next((i for i, line in enumerate(lines) if line.startswith('ENTITY-CODE')), None)
    if begin is None:
        raise FormatError('no line ENTITY-CODE', where=source, cure='save it as FORM-A')
    header = [cell.strip() for cell in lines[begin].split('\t')]
    first = next((i for i, cell in enumerate(header) if i and cell), len(header))
    vertices: list[_Vertex] = []
    latest: list[int] = []
    for number, line in enumerate(lines[begin + 1 :], start=begin + 2):
        cells = line.rstrip().split('\t')
        if not line.strip():
            continue
        where = f'{source}:{number}'
        column = next((i for i, cell in enumerate(cells[:first]) if cell.strip()), None)
        if column is None:
            raise FormatError(f'no code in the first {first} columns', where=where)
        code = cells[column].strip()
        has_predecessor = code.startswith('^')
        if column - (not has_predecessor) >= len(latest):
            raise TreeError(f"'{code[:20]}' has no parent", where=where, cure='check its column')
        reference = latest[column] if has_predecessor else (latest[column - 1] if column else -1)
        reference = _add(vertices, code.removeprefix('^'), reference, scales, where)
        del latest[column:]
        latest.append(reference)
        for name, cell in zip(header[first:], cells[first:], strict=False):
            value = finite(cell)
            if value is not None:
                vertices[reference].features[name] = value
    if not vertices:
        raise FormatError('no vertices', where=source)
    return vertices


def _scales(lines: list[str], source: str) -> dict[str, int]:
    """Scale of each class, from the section CLASSES."""
    code = next((line.partition(':')[2].strip() for line in lines if line.startswith('CODE')), '')
    if not code.startswith('FORM-A'):
        raise FormatError(f"the code is '{code[:20]}', not FORM-A", where=source)
    begin = next((i for i, line in enumerate(lines) if line.startswith('SYMBOL')), len(lines))
    scales = {}
    for line in lines[begin + 1 :]:
        cells = line.split()
        if len(cells) < 2 or finite(cells[1]) is None:
            break
        scales[cells[0]] = int(finite(cells[1]) or 0)
    if not scales:
        raise FormatError('no CLASSES with SYMBOL and SCALE', where=source)
    return scales


def _add(
    vertices: list[_Vertex], code: str, reference: int, scales: dict[str, int], where: str
) -> int:
    """Add the vertices of a code, such as ``/P1/A1``, and return the last one."""
    parts = list(_CODE.finditer(code))
    if not parts or ''.join(part[0] for part in parts) != code:
        raise FormatError(
            f"'{code[:20]}' is not a code", where=where, cure='such as /P1, <S2 or +A1'
        )
    for edge, name in (part.groups() for part in parts):
        symbol = name.rstrip('0123456789')
        if symbol not in scales:
            raise FormatError(f"no class '{symbol}'", where=where, cure='list it under CLASSES')
        scale, above = scales[symbol], vertices[reference].scale if reference >= 0 else 0
        label = f'{where}: {name}'
        if edge == '/':
            if scale != above + 1:
                raise TreeError(f'scale {scale} in scale {above}', where=label)
            # The first part of a branch has the place of its branch.
            on = vertices[reference].parent if reference >= 0 else -1
            vertex = _Vertex(label, scale, edge, reference, on)
        else:
            whole = reference
            while whole >= 0 and vertices[whole].scale > scale:
                whole = vertices[whole].complex
            if whole < 0 or vertices[whole].scale != scale:
                raise TreeError(f"'{edge}' has nothing of scale {scale} before it", where=label)
            vertex = _Vertex(label, scale, edge, vertices[whole].complex, reference)
        vertices.append(vertex)
        reference = len(vertices) - 1
    return reference


_UNITS = {'length_unit': 0.01, 'diameter_unit': 0.001, **MEASURED}
FORMAT = FileFormat('mtg', ('.mtg',), _is_mtg, _read, _UNITS)
