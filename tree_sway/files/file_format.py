# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Formats of files: name, sniffer and reader; and the format of a file."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
import re
from typing import Any

from tree_sway.errors import FormatError, ParameterError
from tree_sway.files.column_names import folded, is_named
from tree_sway.files.foreign_file import foreign_file
from tree_sway.files.table_file import filled_lines
from tree_sway.files.text_file import read_head

_POINTS = 8
"""Lines that are looked at for whether a file is a cloud of points."""
_POINT = re.compile(r'\s*[-+]?\d+(\.\d+)?([\s,;]+[-+]?\d+(\.\d+)?){2,8}\s*')


_OF_TREES = ('species', 'diameter', 'girth')


class UnknownFormatError(FormatError):
    """A file that no format recognises."""


@dataclass(frozen=True)
class FileFormat:
    """
    A format of files.

    ``name`` is also the value of the option ``format``; suffixes are in lower case. ``recognise``
    decides by the beginning of a file, as text with all else replaced; arguments of ``read`` after
    the path are the options of the format. ``defaults`` are those of the options of all trees that
    are not as in `TreeOptions`.
    """

    name: str
    suffixes: tuple[str, ...]
    recognise: Callable[[str], bool]
    read: Callable[..., Any]
    defaults: Mapping[str, Any] = field(default_factory=dict)

    @property
    def own_options(self) -> tuple[str, ...]:
        """Options of the reader itself."""
        return tuple(name for name in self.read.__annotations__ if name not in ('path', 'return'))

    def refuse_others(self, options: Iterable[str], known: Sequence[str]) -> None:
        """Raise a `ParameterError` for the first option that is not among those known."""
        for option in options:
            if option not in known:
                raise ParameterError(
                    f"format {self.name} has no option '{option}'",
                    cure=f'it has: {", ".join(known)}',
                )


def contains(pattern: str) -> Callable[[str], bool]:
    """Recognise a format by a regular expression, found anywhere in the beginning of a file."""
    compiled = re.compile(pattern, re.MULTILINE)
    return lambda head: compiled.search(head) is not None


def has_columns(*names: str) -> Callable[[str], bool]:
    """Recognise a table by the columns in its first line that is not a comment, folded."""
    wanted = set(map(folded, names))

    def recognise(head: str) -> bool:
        _, lines = filled_lines(head.splitlines())
        return wanted <= set(map(folded, re.split('[,;\t]', ''.join(lines[:1]))))

    return recognise


def format_of(
    path: Path,
    name: str | None,
    formats: Sequence[FileFormat],
    kind: str,
    *,
    folder: str = '',
    head: str | None = None,
) -> FileFormat:
    """
    Return the format of a file: the given one, else by its content, then by its suffix.

    The first that recognises the content is used; ``kind`` (the contents of the files) is for the
    errors, ``folder`` the name of the format that is a folder, if there is one, ``head`` the
    beginning of the file where it was read before.

    Raises
    ------
    UnknownFormatError
        If no format fits, and the suffix does not tell what the file is.
    FormatError
        If the file is of another kind, such as a mesh, or numbers have decimal commas.
    ParameterError
        If no format has that name.

    """
    by_name = {each.name: each for each in formats}
    names = ', '.join(by_name)
    if wanted := name or (folder if folder and path.is_dir() else ''):
        if wanted not in by_name:
            raise ParameterError(f"unknown {kind} format '{wanted}'", cure=f'use {names}')
        return by_name[wanted]
    head = read_head(path) if head is None else head
    what, cure = foreign_file(path, head or ' ')
    if what:
        raise FormatError(f'{what}, not a {kind}', cure=cure)
    with_points = re.sub(r'(?<=\d),(?=\d)', '.', head)
    for known in formats:
        if known.recognise(head):
            return known
    if any(known.recognise(with_points) for known in formats):
        raise FormatError('numbers with a decimal comma', cure='export it with decimal points')
    of_suffix = [known for known in formats if path.suffix.lower() in known.suffixes]
    if len(of_suffix) == 1:
        return of_suffix[0]
    if _is_header_alone(head):
        raise FormatError('a header and no rows', cure='write rows below its header')
    raise _unknown(path, head, kind, names)


def _is_header_alone(head: str) -> bool:
    """Whether the beginning of a file is one row of cells, none of them a number."""
    _, lines = filled_lines(head.splitlines())
    return len(lines) == 1 and re.fullmatch(r'\D*[,;\t]\D*', lines[0]) is not None


def _is_cloud(head: str) -> bool:
    """Whether all lines are three to nine numbers, as points with colours."""
    lines = head.splitlines()[:_POINTS]
    return len(lines) == _POINTS and all(map(_POINT.fullmatch, lines))


def _unknown(path: Path, head: str, kind: str, names: str) -> FormatError:
    """Return the error for a file of no format: what it is, if its suffix tells, or its kind."""
    what, cure = foreign_file(path)
    if not what and kind == 'tree' and _is_cloud(head):
        what, cure = foreign_file(Path('cloud.las'))
    if what:
        cures = filter(None, (cure, f'formats that are read: {names}'))
        return FormatError(f'{what}, not a {kind}', cure='; '.join(cures))
    cure = f'give one of {names}, or give its format'
    if head and kind == 'tree':
        cells = re.split('[,;\t]', head.partition('\n')[0])
        names_trees = any(is_named(cell, *_OF_TREES) for cell in cells)
        need = (
            'an inventory has columns for the place, the species, and the height or dbh; a tree '
            'as a table has segment, parent, x0, y0, z0, x1, y1, z1, d0, d1 [m]'
        )
        cure = f'{need}; {cure}' if names_trees else f'{cure}; {need}'
    return UnknownFormatError(f'a file of an unknown {kind} format', cure=cure)
