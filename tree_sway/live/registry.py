# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Every kind of source, and a source opened by its address."""

from __future__ import annotations

from dataclasses import replace
import importlib

from tree_sway.live import sources
from tree_sway.live.source import Source, WEST
from tree_sway.live.source_address import read_source_address
from tree_sway.tables import table_beside

SOURCE_KINDS = table_beside(sources.__file__, 'sources.csv')
"""Every kind: its module in `sources`, schemes and an example of its addresses."""


def open_source(text: str) -> Source:
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
    kinds = {scheme: kind for kind in SOURCE_KINDS for scheme in kind['schemes'].split()}
    forms = ', '.join(kind['form'] for kind in SOURCE_KINDS)
    kind = address.kind_of(kinds, 'source of wind', 'sensor', forms)
    module = importlib.import_module(f'{sources.__name__}.{kind["module"]}')
    source: Source = module.open_source(address)
    opened = replace(
        source,
        name=', '.join(filter(None, (address.name, source.name))),
        mean=address.number('mean', 0.0, 0.0, 86_400.0) if address.text_of('mean') else None,
        bearing=address.angle('from_degrees', WEST),
        is_without_vane='from_degrees' in address.options,
    )
    address.refuse_others()
    return opened
