"""
TreeQSM's MATLAB files: structs with a field ``cylinder``, or the loose variables of version 2.0.

Versions 5 to 7 of the file format are read here; version 7.3 is HDF5 and needs h5py. A file may
hold several models, as variables or as an array of structs; each is a tree.

"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from tree_sway_ros.errors import FormatError, MissingDependencyError
from tree_sway_ros.files.text_file import read_bytes
from tree_sway_ros.files.trees.cylinders.cylinders import Cylinders
from tree_sway_ros.files.trees.cylinders.mat5 import MatArray, read_mat5
from tree_sway_ros.files.trees.cylinders.treeqsm_columns import treeqsm_cylinders

_FIELDS = (
    ("radius", "Rad"), ("length", "Len"), ("start", "Sta"), ("axis", "Axe"), ("parent", "CPar"),
    ("extension", "CExt"),
)  # fmt: skip
"""Fields of ``cylinder``, and their names as loose variables."""
_MAX_VALUES = 20_000_000


def looks_like_mat(head: str) -> bool:
    """Whether the beginning of a file is that of a MATLAB file."""
    return head.startswith("MATLAB") or head.startswith("\ufffdHDF\r\n\x1a\n")


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
    source = str(path)
    head = read_bytes(path, at_most=128)
    is_hdf5 = b"HDF\r\n" in head[:8] or head.startswith(b"MATLAB 7.3")
    models = list(_models_of_hdf5(path) if is_hdf5 else _models_of_mat(path))
    if not models:
        raise FormatError(
            "no struct with a field 'cylinder'", where=source, cure="save the QSM struct of TreeQSM"
        )
    return tuple(_cylinders(name, fields, source) for name, fields in models)


def _cylinders(name: str, fields: Mapping[str, Any], source: str) -> Cylinders:
    columns = []
    for names in _FIELDS:
        found = next((fields[key] for key in names if key in fields), None)
        if found is None:
            raise FormatError(f"{name} has no field '{names[0]}'", where=source)
        columns.append(np.atleast_1d(np.asarray(found, dtype=np.float64)))
    n = columns[0].size
    for i in (2, 3):  # a single cylinder was squeezed to one dimension
        columns[i] = columns[i].reshape(1, 3) if columns[i].shape == (3,) else columns[i]
    labels = [f"{source}: {name} cylinder {i + 1}" for i in range(n)]
    radius, length, start, axis, parent, extension = columns
    cylinders = treeqsm_cylinders(radius, length, start, axis, parent, extension, labels, source)
    cylinders.name = name
    return cylinders


def _models_of_mat(path: Path) -> Iterator[tuple[str, Mapping[str, Any]]]:
    try:
        content = read_mat5(read_bytes(path))
        for name, variable in content.items():
            several = max(variable.shape, default=1) > 1
            for number, fields in enumerate(variable.structs(), start=1):
                inside = fields.get("cylinder")
                cylinder = fields if inside is None else next(inside.structs(), {})
                if "radius" in cylinder:
                    yield (f"{name}{number}" if several else name), _numbers(cylinder)
        if "Rad" in content:
            yield "QSM", _numbers(content)
    except FormatError as error:
        if error.where:
            raise
        what = f"not a MATLAB file that can be read: {error.what}"
        raise FormatError(what, where=str(path), cure="save it anew") from None


def _numbers(fields: Mapping[str, MatArray]) -> dict[str, Any]:
    wanted = {name for names in _FIELDS for name in names}
    return {name: array.numbers().squeeze() for name, array in fields.items() if name in wanted}


def _models_of_hdf5(path: Path) -> Iterator[tuple[str, Mapping[str, Any]]]:
    try:
        import h5py
    except ImportError as error:
        raise MissingDependencyError(
            "a MATLAB file of version 7.3 needs h5py",
            where=str(path),
            cure="pip install h5py, or save it with the option -v7",
        ) from error
    try:
        with h5py.File(path, "r") as file:
            for name, group in file.items():
                if name.startswith("#") or not isinstance(group, h5py.Group):
                    continue
                inside = group.get("cylinder", group)
                if isinstance(inside, h5py.Group):
                    if "radius" in inside:
                        yield name, _arrays(inside)
                    continue
                for number, reference in enumerate(np.ravel(inside[()]), start=1):
                    yield f"{name}{number}", _arrays(file[reference])
    except (FormatError, GeneratorExit):
        raise
    except Exception as error:
        raise FormatError(
            f"not an HDF5 file that can be read: {type(error).__name__}: {error}"[:200],
            where=str(path),
        ) from error


def _arrays(group: Any) -> dict[str, Any]:
    """Fields of a cylinder group; MATLAB's columns are HDF5's rows."""
    wanted = {name for names in _FIELDS for name in names}
    for name in wanted & set(group):
        if group[name].size > _MAX_VALUES:
            raise FormatError(f"{name} has {group[name].size} values", where=group.file.filename)
    return {name: np.transpose(group[name][()]).squeeze() for name in group if name in wanted}
