# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Options of an address for JSON and ``name=value``: paths of the values, and their unit."""

from __future__ import annotations

from tree_sway.files import unit_factor
from tree_sway.live.readers.json_path import JsonPath
from tree_sway.live.readers.named_values import WindNames
from tree_sway.live.source_address import SourceAddress


def names_of(address: SourceAddress) -> WindNames:
    """
    Read the paths ``speed``, ``direction`` and ``gust``, and ``unit``.

    Raises a `ParameterError` for text that is no path.
    """
    return WindNames(
        _path(address, 'speed'),
        _path(address, 'direction'),
        _path(address, 'gust'),
        address.text_of('unit'),
    )


def factor_of(address: SourceAddress) -> float:
    """Return the option ``unit`` in [m/s]; raises a `ParameterError` for an unknown one."""
    unit = address.text_of('unit', 'm/s')
    factor = unit_factor('speed', unit)
    if factor is None:
        raise address.error(f"unknown unit '{unit}'", 'use m/s, km/h, kn, mph or ft/s')
    return factor


def _path(address: SourceAddress, name: str) -> JsonPath | None:
    text = address.text_of(name)
    return JsonPath(text) if text else None
