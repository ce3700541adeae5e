"""
Read a tree from a file of any known format.

The content decides, the suffix breaks ties: files of the field come with the suffix of the day. A new
format is one file with a reader, and one line here.

"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tree_sway_ros.errors import FormatError, ParameterError
from tree_sway_ros.importers.imported_tree import TreeFile
from tree_sway_ros.importers.text_file import read_head
from tree_sway_ros.importers.tree_csv import read_csv_tree
from tree_sway_ros.importers.tree_yaml import read_yaml_tree


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
        Reader of the trees of such a file.

    """

    name: str
    suffixes: tuple[str, ...]
    recognise: Callable[[str], bool]
    read: Callable[..., TreeFile | tuple[TreeFile, ...]]


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
    TreeFormat("csv", (".csv", ".txt"), _columns("x0", "y0", "z0", "x1", "d0"), read_csv_tree),
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
        What the reader of the format takes, such as ``species``.

    Raises
    ------
    FormatError
        A file of no known format, or one that does not hold what its format promises.
    TreeError
        A tree that cannot be.
    ParameterError
        An option that the reader of this format does not have.

    """
    path = Path(path)
    chosen = _format_of(path) if format is None else _format_named(format)
    known = chosen.read.__annotations__
    for option in options:
        if option not in known:
            names = ", ".join(name for name in known if name not in ("path", "return")) or "none"
            raise ParameterError(
                f"format {chosen.name} has no option '{option}'", cure=f"it has: {names}"
            )
    trees = chosen.read(path, **options)
    return (trees,) if isinstance(trees, TreeFile) else trees


def read_tree(path: str | Path, format: str | None = None, **options: Any) -> TreeFile:
    """
    Read the tree of a file, the first if it holds several; see `read_trees`.

    The notes of the result say how many others there are.

    """
    first, *others = read_trees(path, format, **options)
    if not others:
        return first
    note = f"the file holds {len(others)} more trees"
    return TreeFile(first.tree, first.species, first.source, (*first.notes, note))


def _format_named(name: str) -> TreeFormat:
    for known in TREE_FORMATS:
        if known.name == name:
            return known
    raise ParameterError(
        f"unknown tree format '{name}'", cure=f"use {', '.join(f.name for f in TREE_FORMATS)}"
    )


def _format_of(path: Path) -> TreeFormat:
    head = read_head(path).decode("utf-8", errors="replace")
    suffix = path.suffix.lower()
    by_content = [known for known in TREE_FORMATS if known.recognise(head)]
    by_suffix = [known for known in by_content or TREE_FORMATS if suffix in known.suffixes]
    candidates = by_suffix or by_content
    if by_content or len(by_suffix) == 1:
        return candidates[0]
    raise FormatError(
        "a file of no known tree format",
        where=str(path),
        cure=f"give one of {', '.join(f.name for f in TREE_FORMATS)}, or say its format",
    )
