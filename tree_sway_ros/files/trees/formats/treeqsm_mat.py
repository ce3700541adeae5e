# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
TreeQSM's MATLAB files: structs with a field ``cylinder``, loose variables or one matrix.

Version 2.0 saves loose variables, older ones a matrix ``CylData`` of a row per cylinder. A file may
hold several models, as variables or as an array of structs; each is a tree.

"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from tree_sway_ros.errors import FormatError
from tree_sway_ros.files.trees.cylinders.cylinders import Cylinders
from tree_sway_ros.files.trees.cylinders.mat_file import looks_like_mat, numbers, read_mat
from tree_sway_ros.files.trees.cylinders.treeqsm_columns import (
    USED_COLUMNS,
    looks_like_cylinders,
    treeqsm_cylinders,
)
from tree_sway_ros.files.trees.tree_format import TreeFormat

_FIELDS = (
    ("radius", "Rad"), ("length", "Len"), ("start", "Sta"), ("axis", "Axe"), ("parent", "CPar"),
    ("extension", "CExt"),
)  # fmt: skip
"""Fields of ``cylinder``, and their names as loose variables."""


def read_treeqsm_mat(path: Path) -> tuple[Cylinders, ...]:
    """
    Read every cylinder model of a MATLAB file.

    Raises
    ------
    FormatError
        Not a MATLAB file, damaged, or without a cylinder model.
    MissingDependencyError
        If it is of version 7.3 and h5py is not installed.

    """
    models = list(_models(read_mat(path)))
    if not models:
        raise FormatError(
            "no struct with a field 'cylinder' and no matrix of cylinders",
            where=str(path),
            cure="save the QSM struct of TreeQSM",
        )
    return tuple(_cylinders(name, columns, str(path)) for name, columns in models)


def _models(variables: dict[str, Any]) -> Iterator[tuple[str, Any]]:
    """Name and columns of each cylinder model: by field name, or as a matrix."""
    for name, value in variables.items():
        several = isinstance(value, list) and len(value) > 1
        for number, struct in enumerate(_structs(value), start=1):
            inside = next(iter(_structs(struct.get("cylinder", struct))), {})
            if "radius" in inside:
                yield (f"{name}{number}" if several else name), inside
    if "Rad" in variables:
        yield "QSM", variables
    for name, value in variables.items():
        if isinstance(value, np.ndarray) and value.dtype.kind == "f" and value.ndim == 2:
            if looks_like_cylinders(value):
                yield name, value


def _structs(value: Any) -> list[dict[str, Any]]:
    values = value if isinstance(value, list) else [value]
    return [each for each in values if isinstance(each, dict)]


def _cylinders(name: str, columns: Any, source: str) -> Cylinders:
    if isinstance(columns, np.ndarray):
        table = columns[:, :USED_COLUMNS].astype(np.float64)
    else:
        table = _table(name, columns, source)
    labels = [f"{source}: {name} cylinder {i + 1}" for i in range(len(table))]
    cylinders = treeqsm_cylinders(table, labels, source)
    cylinders.name = name
    return cylinders


def _table(name: str, fields: dict[str, Any], source: str) -> Any:
    """Columns of the table of cylinders from fields of their names."""
    columns = []
    for names in _FIELDS:
        found = next((key for key in names if key in fields), None)
        if found is None:
            raise FormatError(f"{name} has no field '{names[0]}'", where=source)
        try:
            column = numbers(fields[found], found)
        except FormatError as error:
            raise FormatError(error.what, where=f"{source}: {name}") from None
        width = 3 if names[0] in ("start", "axis") else 1
        if column.size % width:
            raise FormatError(f"{name}.{found} has {column.size} values", where=source)
        columns.append(column.reshape(-1, width))
    if len({len(column) for column in columns}) > 1:
        raise FormatError("columns of different lengths", where=source, cure="export it anew")
    return np.hstack(columns)


FORMAT = TreeFormat("treeqsm-mat", (".mat",), looks_like_mat, read_treeqsm_mat)
