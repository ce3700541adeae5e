# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A section of the validation: checks with figure and limit, a table, how it was measured."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Sequence
import math
from pathlib import Path
from typing import Any, NamedTuple, Protocol

HOLDS, MISSES = 'holds', '**misses**'
CHECKS = '| check | measured | limit | |'
"""Head of the table of checks."""


class Each(Protocol):
    """Applies a function to items, on all cores, and returns the results in their order."""

    def __call__(self, function: Callable[..., Any], items: Collection[Any], /) -> list[Any]:
        """Apply it."""


class Effort(NamedTuple):
    """
    How much to measure, and with what.

    Parameters
    ----------
    each
        Applies a function to items.
    is_full
        Whether more trees and longer winds than usual are wanted.
    data
        Folder with recorded trees and winds, in ``trees`` and ``wind``; None if they are missing.

    """

    each: Each
    is_full: bool = False
    data: Path | None = None


class Check(NamedTuple):
    """
    A figure and its limits.

    Parameters
    ----------
    what
        Quantity that is measured.
    measured
        The figure.
    low, high
        Limits of the figure.

    """

    what: str
    measured: float
    low: float = -math.inf
    high: float = math.inf

    @property
    def holds(self) -> bool:
        """Whether the figure is within its limits."""
        return self.low <= self.measured <= self.high

    def row(self) -> str:
        """Return it as a row of a table."""
        if math.isinf(self.low):
            limit = f'at most {self.high:g}'
        elif math.isinf(self.high):
            limit = f'at least {self.low:g}'
        else:
            limit = f'{self.low:g} to {self.high:g}'
        return (
            f'| {self.what} | {self.measured:.3g} | {limit} | {HOLDS if self.holds else MISSES} |'
        )


class Section(NamedTuple):
    """
    Result of a section.

    Parameters
    ----------
    title
        Title of the section.
    text
        Description of the measurement.
    checks
        Checks that must hold.
    table
        Further figures, in Markdown.

    """

    title: str
    text: str
    checks: Sequence[Check]
    table: str = ''

    def markdown(self) -> str:
        """Return the section as Markdown, with its marks."""
        parts = [f'## {self.title}\n', f'{self.text}\n']
        head = f'{CHECKS}\n|---|---|---|---|'
        if self.checks:
            parts.append('\n'.join((head, *(check.row() for check in self.checks))) + '\n')
        if self.table:
            parts.append(self.table)
        return '\n'.join(parts)


def markdown_table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a table in Markdown."""
    lines = [' | '.join(head), '|'.join('---' for _ in head), *(' | '.join(row) for row in rows)]
    return (
        '\n'.join(f'| {line} |' if k != 1 else f'|{line}|' for k, line in enumerate(lines)) + '\n'
    )
