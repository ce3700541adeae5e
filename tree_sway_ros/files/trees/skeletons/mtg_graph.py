# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The multiscale tree graph of an MTG file in the code FORM-A (Godin & Caraglio 1998).

Each line of the section MTG holds a vertex, in the column that is its depth, and the values of its
features. ``/`` decomposes, ``<`` goes on, ``+`` branches; with ``^`` before, it does so from the
vertex above in its own column, else from the latest in the column before.

"""

from __future__ import annotations

import re
from dataclasses import dataclass, field

from tree_sway_ros.errors import FormatError, TreeError
from tree_sway_ros.files.text_file import finite

_CODE = re.compile(r"([/<+])([A-Za-z]\w*)(?=[/<+]|$)", re.ASCII)


@dataclass(slots=True)
class MtgVertex:
    """
    A vertex of the graph.

    Parameters
    ----------
    label
        What an error calls it: its line, class and number.
    scale
        1 for the plant, more for its parts.
    edge
        ``/``, ``<`` or ``+``: how it is tied to the vertex it was written after.
    complex
        Vertex that it is a part of, -1 for the plant.
    parent
        Vertex of its own scale, or of a finer one, that it sits on; -1 for none.
    features
        Values of its features that are numbers.

    """

    label: str
    scale: int
    edge: str
    complex: int
    parent: int
    features: dict[str, float] = field(default_factory=dict)


def parse_mtg(lines: list[str], source: str) -> list[MtgVertex]:
    """
    Parse the vertices of an MTG file.

    Raises
    ------
    FormatError
        No FORM-A, a section that is missing, a class or code that is not known.
    TreeError
        A vertex that sits on nothing.

    """
    scales = _scales(lines, source)
    begin = next((i for i, line in enumerate(lines) if line.startswith("ENTITY-CODE")), None)
    if begin is None:
        raise FormatError("no line ENTITY-CODE", where=source, cure="save it as FORM-A")
    header = [cell.strip() for cell in lines[begin].split("\t")]
    first = next((i for i, cell in enumerate(header) if i and cell), len(header))
    vertices: list[MtgVertex] = []
    latest: list[int] = []
    for number, line in enumerate(lines[begin + 1 :], start=begin + 2):
        cells = line.rstrip().split("\t")
        if not line.strip():
            continue
        where = f"{source}:{number}"
        column = next((i for i, cell in enumerate(cells[:first]) if cell.strip()), None)
        if column is None:
            raise FormatError(f"no code in the first {first} columns", where=where)
        code = cells[column].strip()
        goes_on = code.startswith("^")
        if column - (not goes_on) >= len(latest):
            raise TreeError(f"'{code[:20]}' sits on nothing", where=where, cure="check its column")
        reference = latest[column] if goes_on else (latest[column - 1] if column else -1)
        reference = _add(vertices, code.removeprefix("^"), reference, scales, where)
        del latest[column:]
        latest.append(reference)
        for name, cell in zip(header[first:], cells[first:], strict=False):
            value = finite(cell)
            if value is not None:
                vertices[reference].features[name] = value
    if not vertices:
        raise FormatError("no vertices", where=source)
    return vertices


def _scales(lines: list[str], source: str) -> dict[str, int]:
    """Scale of each class, from the section CLASSES."""
    code = next((line.partition(":")[2].strip() for line in lines if line.startswith("CODE")), "")
    if not code.startswith("FORM-A"):
        raise FormatError(f"the code is '{code[:20]}', not FORM-A", where=source)
    begin = next((i for i, line in enumerate(lines) if line.startswith("SYMBOL")), len(lines))
    scales = {}
    for line in lines[begin + 1 :]:
        cells = line.split()
        if len(cells) < 2 or finite(cells[1]) is None:
            break
        scales[cells[0]] = int(finite(cells[1]) or 0)
    if not scales:
        raise FormatError("no CLASSES with SYMBOL and SCALE", where=source)
    return scales


def _add(
    vertices: list[MtgVertex], code: str, reference: int, scales: dict[str, int], where: str
) -> int:
    """Add the vertices of a code, such as ``/P1/A1``, and return the last one."""
    parts = list(_CODE.finditer(code))
    if not parts or "".join(part[0] for part in parts) != code:
        raise FormatError(
            f"'{code[:20]}' is not a code", where=where, cure="such as /P1, <S2 or +A1"
        )
    for edge, name in (part.groups() for part in parts):
        symbol = name.rstrip("0123456789")
        if symbol not in scales:
            raise FormatError(f"no class '{symbol}'", where=where, cure="list it under CLASSES")
        scale, above = scales[symbol], vertices[reference].scale if reference >= 0 else 0
        label = f"{where}: {name}"
        if edge == "/":
            if scale != above + 1:
                raise TreeError(f"scale {scale} in scale {above}", where=label)
            # The first part of a branch sits where its branch sits.
            on = vertices[reference].parent if reference >= 0 else -1
            vertex = MtgVertex(label, scale, edge, reference, on)
        else:
            whole = reference
            while whole >= 0 and vertices[whole].scale > scale:
                whole = vertices[whole].complex
            if whole < 0 or vertices[whole].scale != scale:
                raise TreeError(f"'{edge}' has nothing of scale {scale} before it", where=label)
            vertex = MtgVertex(label, scale, edge, vertices[whole].complex, reference)
        vertices.append(vertex)
        reference = len(vertices) - 1
    return reference
