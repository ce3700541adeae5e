# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Every kind of source, and a source opened by its address."""

from __future__ import annotations

from functools import cache
import importlib
import math
from typing import NamedTuple

from tree_sway.live import sources
from tree_sway.live.source import Source
from tree_sway.live.source_address import read_source_address
from tree_sway.tables import table_beside


class SourceKind(NamedTuple):
    """A kind of source: its module in `sources`, schemes and an example of its addresses."""

    module: str
    schemes: tuple[str, ...]
    form: str


class OpenedSource(NamedTuple):
    """
    A source with the options that all have.

    ``name`` is shown to viewers. ``bearing`` is the direction that a wind comes from where the
    instrument has no vane, clockwise from north [rad]. ``mean`` is the length of its means [s] if
    it is given, 0 for the wind of instants. ``is_without_vane`` says that the direction is given.
    """

    source: Source
    name: str
    bearing: float
    mean: float | None
    is_without_vane: bool = False


WEST = 1.5 * math.pi
"""Bearing of a westerly [rad], for a wind without a direction."""


@cache
def source_kinds() -> tuple[SourceKind, ...]:
    """Return every kind, as the table beside `sources` has them."""
    rows = table_beside(sources.__file__, 'sources.csv')
    return tuple(
        SourceKind(each['module'], tuple(each['schemes'].split()), each['form']) for each in rows
    )


def open_source(text: str) -> OpenedSource:
    """
    Open a source by its address.

    Options of every source are ``name``, for viewers; ``from_degrees``, the direction of a wind
    without one; and ``mean``, the length of its means in [s].

    Raises
    ------
    ParameterError
        An unknown kind of source, or an option that it does not have.
    MissingDependencyError
        A library that it needs is not installed.

    """
    address = read_source_address(text)
    kinds = {scheme: kind for kind in source_kinds() for scheme in kind.schemes}
    forms = ', '.join(kind.form for kind in source_kinds())
    kind = address.kind_of(kinds, 'source of wind', 'sensor', forms)
    module = importlib.import_module(f'{sources.__name__}.{kind.module}')
    source: Source = module.open_source(address)
    name = address.name
    bearing = address.angle('from_degrees', WEST)
    given = address.text_of('mean')
    mean = address.number('mean', 0.0, 0.0, 86_400.0) if given else None
    address.refuse_others()
    shown = f'{name}, {source.name}' if name else source.name
    return OpenedSource(source, shown, bearing, mean, 'from_degrees' in address.options)
