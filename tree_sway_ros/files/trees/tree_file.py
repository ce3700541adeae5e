"""
Read a tree from a file of any known format.

The content decides, the suffix breaks ties: files of the field come with the suffix of the day. A
new format is one file with a reader, and one line here.

"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Any

from tree_sway_ros.errors import FormatError, ParameterError
from tree_sway_ros.files.text_file import path_of, read_head
from tree_sway_ros.files.trees.cylinders.archi import read_archi_csv
from tree_sway_ros.files.trees.cylinders.cylinder_tree import CylinderOptions, tree_of_cylinders
from tree_sway_ros.files.trees.cylinders.cylinders import Cylinders
from tree_sway_ros.files.trees.cylinders.mat_file import looks_like_mat
from tree_sway_ros.files.trees.cylinders.simpleforest import read_simpleforest_csv
from tree_sway_ros.files.trees.cylinders.treeqsm_mat import read_treeqsm_mat
from tree_sway_ros.files.trees.cylinders.treeqsm_text import (
    looks_like_treeqsm_text,
    read_treeqsm_text,
)
from tree_sway_ros.files.trees.file_units import FileUnits
from tree_sway_ros.files.trees.imported_tree import TreeFile
from tree_sway_ros.files.trees.segment_table import read_csv_tree
from tree_sway_ros.files.trees.skeletons.mtg import looks_like_mtg, read_mtg
from tree_sway_ros.files.trees.skeletons.raycloud import looks_like_treefile, read_treefile
from tree_sway_ros.files.trees.skeletons.swc import looks_like_swc, read_swc
from tree_sway_ros.files.trees.yaml.tree_yaml import read_yaml_tree


@dataclass(frozen=True)
class TreeFormat:
    """
    A format of tree files.

    Parameters
    ----------
    name
        Its name for people and for the ``format`` option.
    suffixes
        Its usual suffixes, lower case.
    recognise
        Whether the beginning of a file, as text with all else replaced, looks like it.
    read
        Reader of such a file: of a tree, or of the cylinders of trees, which take all of
        `CylinderOptions` besides the reader's own options.

    """

    name: str
    suffixes: tuple[str, ...]
    recognise: Callable[[str], bool]
    read: Callable[..., TreeFile | tuple[Cylinders, ...]]

    @property
    def own_options(self) -> tuple[str, ...]:
        """Options of the reader itself."""
        return tuple(name for name in self.read.__annotations__ if name not in ("path", "return"))

    @property
    def options(self) -> tuple[str, ...]:
        """Every option that the format takes."""
        own = self.own_options
        if "Cylinders" in str(self.read.__annotations__["return"]):
            own = (*own, *(field.name for field in fields(CylinderOptions)))
        return (*own, *(field.name for field in fields(FileUnits) if field.name not in own))


def _columns(*names: str) -> Callable[[str], bool]:
    """Recognise a table by the columns in its first line that is no comment."""

    def recognise(head: str) -> bool:
        for line in head.splitlines():
            if line.strip() and not line.startswith("#"):
                cells = {cell.strip(' "').lower() for cell in re.split("[,;\t]", line)}
                return all(name.lower() in cells for name in names)
        return False

    return recognise


def _yaml(head: str) -> bool:
    return re.search(r"^\{?\s*(tree_sway|branches|segments)\s*:", head, re.MULTILINE) is not None


TREE_FORMATS: tuple[TreeFormat, ...] = (
    TreeFormat("yaml", (".yaml", ".yml", ".json"), _yaml, read_yaml_tree),
    TreeFormat("csv", (".csv",), _columns("x0", "y0", "z0", "x1", "d0"), read_csv_tree),
    TreeFormat(
        "simpleforest", (), _columns("ID", "parentID", "growthLength"), read_simpleforest_csv
    ),
    TreeFormat("archi", (), _columns("cyl_ID", "extension_ID"), read_archi_csv),
    TreeFormat("treeqsm-mat", (".mat",), looks_like_mat, read_treeqsm_mat),
    TreeFormat("treeqsm-text", (".cyl",), looks_like_treeqsm_text, read_treeqsm_text),
    TreeFormat("treefile", (), looks_like_treefile, read_treefile),
    TreeFormat("mtg", (".mtg",), looks_like_mtg, read_mtg),
    TreeFormat("swc", (".swc",), looks_like_swc, read_swc),
)


def read_trees(path: str | Path, format: str | None = None, **options: Any) -> tuple[TreeFile, ...]:
    """
    Read every tree of a file.

    Parameters
    ----------
    path
        The file.
    format
        Name of its format; found from content and suffix if None.
    **options
        What the reader of the format takes, such as ``species``; for cylinder and skeleton formats
        also those of `CylinderOptions`; for all, those of `FileUnits` that it does not have itself.

    Raises
    ------
    FormatError
        A file of no known format, or one that does not hold what its format promises.
    TreeError
        A tree that cannot be.
    ParameterError
        An option that this format does not have, or has otherwise.

    """
    path = path_of(path)
    chosen = _format_of(path) if format is None else _format_named(format)
    for option in options:
        if option not in chosen.options:
            names = ", ".join(chosen.options) or "none"
            raise ParameterError(
                f"format {chosen.name} has no option '{option}'", cure=f"it has: {names}"
            )
    _check_kinds(chosen, options)
    own = {name: options.pop(name) for name in chosen.own_options if name in options}
    shared = {field.name for field in fields(FileUnits)} & set(options)
    units = FileUnits(**{name: options.pop(name) for name in shared})
    content = chosen.read(path, **own)
    if isinstance(content, TreeFile):
        return (units.of_tree(content),)
    settings = CylinderOptions(**options)
    return tuple(tree_of_cylinders(units.of_cylinders(c), path, settings) for c in content)


def read_tree(path: str | Path, format: str | None = None, **options: Any) -> TreeFile:
    """
    Read the tree of a file, the first if it holds several; see `read_trees`.

    The notes of the result say how many others there are.

    """
    first, *others = read_trees(path, format, **options)
    if not others:
        return first
    return replace(first, notes=(*first.notes, f"the file holds {len(others)} more trees"))


def _check_kinds(chosen: TreeFormat, options: dict[str, Any]) -> None:
    """Refuse values of another kind than the option's."""
    kinds = {field.name: str(field.type) for field in fields(CylinderOptions)}
    kinds |= {field.name: str(field.type) for field in fields(FileUnits)}
    kinds |= {name: str(kind) for name, kind in chosen.read.__annotations__.items()}
    for name, value in options.items():
        wanted = kinds[name].split(" ")[0]
        is_number = isinstance(value, int | float) and not isinstance(value, bool)
        fits = {"float": is_number, "bool": isinstance(value, bool), "str": isinstance(value, str)}
        fits["int"] = is_number and float(value).is_integer()
        if not (fits[wanted] or (value is None and "None" in kinds[name])):
            cure = {
                "float": "a number",
                "int": "a whole number",
                "bool": "true or false",
                "str": "a text",
            }
            raise ParameterError(f"option {name} is '{value}'", cure=f"give {cure[wanted]}")


def _format_named(name: str) -> TreeFormat:
    for known in TREE_FORMATS:
        if known.name == name:
            return known
    raise ParameterError(
        f"unknown tree format '{name}'", cure=f"use {', '.join(f.name for f in TREE_FORMATS)}"
    )


def _format_of(path: Path) -> TreeFormat:
    head = read_head(path).decode("utf-8", errors="replace")
    by_content = [known for known in TREE_FORMATS if known.recognise(head)]
    with_points = re.sub(r"(?<=\d),(?=\d)", ".", head)
    if not by_content and any(known.recognise(with_points) for known in TREE_FORMATS):
        raise FormatError(
            "numbers with a decimal comma", where=str(path), cure="export it with decimal points"
        )
    by_suffix = [
        known for known in by_content or TREE_FORMATS if path.suffix.lower() in known.suffixes
    ]
    for candidates in (by_suffix, by_content):
        if candidates:
            return candidates[0]
    raise FormatError(
        "a file of no known tree format",
        where=str(path),
        cure=f"give one of {', '.join(f.name for f in TREE_FORMATS)}, or say its format",
    )
