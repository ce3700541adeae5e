# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Types of errors: each has what is wrong, where, and the cure.

The command line and the nodes turn a `TreeSwayError` into one line and exit code 2. Its parts are
the attributes ``what``, ``where`` and ``cure``; the offending value is in the text of ``what``.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager

LONGEST_NOTE = 1000
"""Letters of a note on a file that are shown on one line."""


class TreeSwayError(Exception):
    """
    Root of all errors of this package.

    Parameters
    ----------
    what
        Description of the fault, with the offending value.
    where
        File, line, segment, branch or parameter of the fault; may be empty.
    cure
        Action for the user; may be empty.

    """

    def __init__(self, what: str, *, where: str = '', cure: str = '') -> None:
        """Join the three parts into one line."""
        self.what = shown(what)
        self.where = shown(where)
        self.cure = shown(cure, 1000)
        place = f'{self.where}: ' if where else ''
        advice = f'; {self.cure}' if cure else ''
        super().__init__(f'{place}{self.what}{advice}')

    def at(self, where: str) -> TreeSwayError:
        """Return the error with a different place."""
        return type(self)(self.what, where=where, cure=self.cure)

    def inside(self, whole: str) -> TreeSwayError:
        """Return the error with its place as a part of a larger one, which it may name already."""
        if self.where.startswith(shown(whole)):
            return self
        if not self.where or whole == f'--{self.where}':
            return self.at(whole)
        return self.at(f'{whole}: {self.where}')


@contextmanager
def inside(whole: str) -> Iterator[None]:
    """Add the larger place to errors of its part."""
    try:
        yield
    except TreeSwayError as error:
        raise error.inside(whole) from None


class TreeError(TreeSwayError):
    """An impossible tree: cyclic, orphaned, zero length, not finite, buckling."""


class FormatError(TreeSwayError):
    """A file with contents that do not match its format."""


class ParameterError(TreeSwayError):
    """A parameter out of its range or of a wrong kind."""


class SpeciesError(TreeSwayError):
    """An unknown species."""


class StateError(TreeSwayError):
    """A state of a different tree, model or version, or no state."""


class MissingDependencyError(TreeSwayError):
    """A missing optional part, such as ROS itself."""


class TransportError(TreeSwayError):
    """A port, domain or middleware that cannot be used."""


def shown(text: str, most: int = 400) -> str:
    """Return a text for one line: without control characters, and cut in its middle."""
    if len(text) > most:
        text = f'{text[: most - 60]} ... {text[-55:]}'
    return ''.join(c if c.isprintable() else ' ' if c.isspace() else ascii(c)[1:-1] for c in text)


def nearest(name: str, known: Iterable[str], least: float = 0.6) -> str:
    """
    Return a question whether the nearest of some names is meant; empty if none is near.

    ``least`` is the share of common letters from which one is.
    """
    from difflib import get_close_matches

    return ''.join(
        f"did you mean '{each}'?" for each in get_close_matches(name, [*known], 1, least)
    )
