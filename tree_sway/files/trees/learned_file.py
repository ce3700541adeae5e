# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A file of a tree that keeps what motion sensors tell about it, over several runs."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from tree_sway.core.setup import is_in_leaf
from tree_sway.core.tree import GrownTree
from tree_sway.core.tree_state import digest_of
from tree_sway.errors import FormatError
from tree_sway.files.atomic_file import refuse_unwritable, write_text_whole
from tree_sway.files.export.yaml_writing import yaml_of_tree
from tree_sway.files.paths import path_of
from tree_sway.files.text_file import read_bytes
from tree_sway.files.trees.imported_tree import TreeFile
from tree_sway.files.trees.yaml.tree_yaml import read_yaml_tree
from tree_sway.twin import LearnedTree

if TYPE_CHECKING:
    from tree_sway.twin import ObservedTree, TreeFit

_SUFFIXES = ('.yaml', '.yml')


def refuse_no_learned_file(path: str) -> None:
    """Raise a `FormatError` for a file that cannot store what is learned."""
    if Path(path).suffix.lower() not in _SUFFIXES:
        raise FormatError('cannot store what is learned', where=path, cure='write a .yaml file')
    refuse_unwritable(path)


class LearnedFile:
    """
    What sensors tell about a tree, in its file.

    Where the file is already there, the tree goes on from what it says: the wood is that of the
    file, and hours add up.

    Parameters
    ----------
    path
        The file.
    grown
        The tree as it was opened.
    in_leaf
        Whether it is in leaf; by its species if None.

    Raises
    ------
    FormatError
        A file that cannot be written or read, is of another tree, or was not learned.
    ParameterError
        Wood in the file that no tree has.

    """

    def __init__(self, path: str, grown: GrownTree, in_leaf: bool | None = None) -> None:
        refuse_no_learned_file(path)
        self.path = path
        self.opened = TreeFile(grown.tree, grown.species, path)
        """The tree, with what was learned before."""
        self._text = _text_of(path)
        if self._text is not None:
            self.opened = _learned_before(path, grown)
        self._in_leaf = is_in_leaf(self.opened.species, in_leaf)
        self._kept: TreeFit | None = None

    def write(self, learned: LearnedTree) -> None:
        """
        Write the tree with what was learned, before and in this run.

        Raises a `FormatError` if another program, or a person, wrote the file meanwhile: it would
        lose what they know.
        """
        if _text_of(self.path) not in (None, self._text):
            raise FormatError(
                'was written by another program meanwhile, and is left as it is',
                where=self.path,
                cure='name another file to learn into',
            )
        newest = learned.over(self.opened.learned)
        species = newest.of(self.opened.species, in_leaf=self._in_leaf)
        text = yaml_of_tree(self.opened.tree, species, learned)
        write_text_whole(self.path, text)
        self._text = text.encode()

    def keep(self, twin: ObservedTree) -> bool:
        """Write what a tree has learned since the last call, if anything; tell whether it was."""
        fit = twin.observer.fit
        learned = twin.learned
        if fit is None or fit is self._kept or learned is None:
            return False
        self._kept = fit
        self.write(learned)
        return True


def _text_of(path: str) -> bytes | None:
    """Return the content of a file; None if there is none."""
    file = path_of(path)
    return read_bytes(file) if file.is_file() else None


def _learned_before(path: str, grown: GrownTree) -> TreeFile:
    """Read the file of a tree; a `FormatError` if it is of another, or was not learned."""
    found = read_yaml_tree(path_of(path)).checked()
    own = replace(grown.tree, species=grown.species.key)
    if digest_of(found.tree) != digest_of(own):
        raise FormatError(
            f'is of another tree than {grown.tree.name}',
            where=path,
            cure='name another file, or open its tree',
        )
    if found.learned is None:
        raise FormatError(
            'is a tree of which nothing was learned, and would be replaced',
            where=path,
            cure='name another file, as oak.twin.yaml',
        )
    return found
