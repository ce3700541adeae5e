"""
Digitised trees in MTG files (FORM-A), with the position and diameter of each vertex.

Positions ``XX YY ZZ`` are those of the upper end of a vertex, in centimetres, and ``TopDia`` its diameter
there in millimetres, as AMAPmod's digitising has them; ``length_unit`` and ``diameter_unit`` say
otherwise. A vertex of a coarser scale, such as an axis, has the position of its base. A segment goes from
the vertex before, or from the base of its axis, to each vertex of the finest scales.

"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from tree_sway_ros.errors import FormatError, ParameterError
from tree_sway_ros.importers.cylinders import Cylinders
from tree_sway_ros.importers.mtg_graph import MtgVertex, parse_mtg
from tree_sway_ros.importers.text_file import read_lines

_POSITION = ("XX", "YY", "ZZ")
_DIAMETER = "TopDia"


def looks_like_mtg(head: str) -> bool:
    """Whether the beginning of a file is that of an MTG file."""
    return any(line.startswith("CODE") and "FORM-" in line for line in head.splitlines())


def read_mtg(
    path: Path, length_unit: float = 0.01, diameter_unit: float = 0.001
) -> tuple[Cylinders, ...]:
    """
    Read a digitised tree.

    Parameters
    ----------
    path
        The file.
    length_unit, diameter_unit
        Unit of its positions and of its diameters in [m].

    Raises
    ------
    FormatError
        No FORM-A, or no vertices with position and diameter.
    TreeError
        A vertex that sits on nothing.

    """
    for unit in (length_unit, diameter_unit):
        if not 0.0 < unit < 1e6:
            raise ParameterError(f"a unit is {unit:g} m", cure="give more than 0")
    source = str(path)
    vertices = parse_mtg(read_lines(path), source)
    placed = [all(name in vertex.features for name in _POSITION) for vertex in vertices]
    scale_of_segments = _scale_of_segments(vertices, placed)
    segment_of: dict[int, int] = {}
    start, end, diameter = list[list[float]](), list[list[float]](), list[list[float]]()
    parent, continues, labels = list[int](), list[bool](), list[str]()
    for index, vertex in enumerate(vertices):
        if vertex.scale != scale_of_segments or not placed[index]:
            continue
        before, follows = _before(vertices, index, placed)
        if before < 0:
            continue  # the first point of a plant that has no base
        carrier = _carrier(vertices, index, segment_of)
        width = _diameter(vertices, index)
        base = vertices[before].features.get(_DIAMETER, width)
        segment_of[index] = len(start)
        start.append([vertices[before].features[name] for name in _POSITION])
        end.append([vertex.features[name] for name in _POSITION])
        diameter.append([base if base > 0.0 else width, width])
        parent.append(carrier)
        continues.append(follows and carrier >= 0)
        labels.append(vertex.label)
    if not start:
        raise FormatError(
            f"no two vertices with {', '.join(_POSITION)}", where=source, cure="digitise the tree"
        )
    cylinders = Cylinders(
        length_unit * np.array(start),
        length_unit * np.array(end),
        diameter_unit * np.array(diameter),
        np.array(parent, dtype=np.int64),
        np.array(continues, dtype=np.bool_),
        labels,
    )
    missing = len(vertices) - sum(placed)
    cylinders.notes = (
        f"{sum(placed)} vertices with a position, {missing} without; {len(start)} of them segments",
    )
    return (cylinders,)


def _scale_of_segments(vertices: list[MtgVertex], placed: list[bool]) -> int:
    """Return the finest scale that has positions."""
    return max((v.scale for v, is_placed in zip(vertices, placed, strict=True) if is_placed), default=0)


def _before(vertices: list[MtgVertex], index: int, placed: list[bool]) -> tuple[int, bool]:
    """Vertex at whose position a segment begins, -1 if none, and whether the segment goes on from it."""
    vertex = vertices[index]
    while True:
        if vertex.edge == "/":
            whole = vertex.complex
            while whole >= 0:
                if placed[whole]:
                    return whole, False
                if vertices[whole].edge != "/":
                    break
                whole = vertices[whole].complex
            before = vertex.parent
            return (before, False) if before >= 0 and placed[before] else (-1, False)
        before = vertex.parent
        if before < 0 or placed[before]:
            return before, before >= 0 and vertex.edge == "<"
        vertex = vertices[before]


def _carrier(vertices: list[MtgVertex], index: int, segment_of: dict[int, int]) -> int:
    """Segment that a vertex sits on, looked for towards the root past those that are none; -1 if none."""
    above = vertices[index].parent
    while above >= 0 and above not in segment_of:
        above = vertices[above].parent
    return segment_of.get(above, -1)


def _diameter(vertices: list[MtgVertex], index: int) -> float:
    """Diameter of a vertex, or of the nearest before it that has one; 0 if none has."""
    while index >= 0:
        width = vertices[index].features.get(_DIAMETER, 0.0)
        if width > 0.0:
            return width
        index = max(vertices[index].parent, -1)
    return 0.0
