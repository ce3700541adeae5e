# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Digitised trees in MTG files (FORM-A), with the position and diameter of each vertex.

Positions ``XX YY ZZ`` are those of the upper end of a vertex, in centimetres, and ``TopDia`` its
diameter there in millimetres, as AMAPmod's digitising has them; ``length_unit`` and
``diameter_unit`` say otherwise. A vertex of a coarser scale, such as an axis, has the position of
its base. A segment goes from the vertex before, or from the base of its axis, to each vertex of the
finest scales.

"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from tree_sway_ros.errors import FormatError, ParameterError
from tree_sway_ros.files.text_file import read_lines
from tree_sway_ros.files.trees.cylinders.cylinders import Cylinders
from tree_sway_ros.files.trees.skeletons.mtg_graph import MtgVertex, parse_mtg
from tree_sway_ros.files.trees.tree_format import TreeFormat

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
    start, end, diameter = list[list[float]](), list[list[float]](), list[list[float]]()
    parent, continues, labels = list[int](), list[bool](), list[str]()
    width, place, carrier = list[float](), list[int](), list[int]()
    for index, vertex in enumerate(vertices):
        before = _before(vertices, vertex, placed, place)
        on = carrier[vertex.parent] if vertex.parent >= 0 else -1
        # What a vertex does not have, those after it take from before it.
        own = vertex.features.get(_DIAMETER, 0.0)
        width.append(own if own > 0.0 or vertex.parent < 0 else width[vertex.parent])
        place.append(index if placed[index] else before)
        carrier.append(on)
        if vertex.scale != scale_of_segments or not placed[index] or before < 0:
            continue  # without anything before it, it is the first point of a plant
        carrier[index] = len(start)
        start.append([vertices[before].features[name] for name in _POSITION])
        end.append([vertex.features[name] for name in _POSITION])
        diameter.append([width[before] if width[before] > 0.0 else width[index], width[index]])
        parent.append(on)
        continues.append(vertex.edge == "<" and before == vertex.parent and on >= 0)
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
    return max(
        (v.scale for v, is_placed in zip(vertices, placed, strict=True) if is_placed), default=0
    )


def _before(
    vertices: list[MtgVertex], vertex: MtgVertex, placed: list[bool], place: list[int]
) -> int:
    """
    Vertex at whose position another one begins, -1 if there is none.

    The base of the axis that it is the first part of, if that has a position; else what it sits on.

    """
    whole = vertex.complex if vertex.edge == "/" else -1
    while whole >= 0:
        if placed[whole]:
            return whole
        whole = vertices[whole].complex if vertices[whole].edge == "/" else -1
    return place[vertex.parent] if vertex.parent >= 0 else -1


FORMAT = TreeFormat("mtg", (".mtg",), looks_like_mtg, read_mtg)
