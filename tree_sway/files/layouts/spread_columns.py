# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Columns of JSON that are lists, beside or far from each other as in CoverageJSON.

Lists called ``data`` or ``values`` are those of the quantity that they are in; its ``unit`` is a
text, or has it as the ``symbol``, maybe in another part of the document.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from tree_sway.files.column_names import is_named
from tree_sway.files.json_values import DEEPEST, list_of, object_of, Record, text_of

_OF_QUANTITY = ('data', 'values')


def spread_rows(node: Any, units: dict[str, str]) -> list[Record]:
    """
    Return records of the columns as long as that of the time, wherever they are in a node.

    There are none without two such columns. Their units are noted.
    """
    columns = dict(_lists(node, '', units))
    size = next((len(values) for name, values in columns.items() if is_named(name, 'time')), 0)
    alike = {name: values for name, values in columns.items() if len(values) == size}
    rows = zip(*alike.values(), strict=True) if len(alike) > 1 else ()
    return [dict(zip(alike, row, strict=True)) for row in rows]


def _lists(
    node: Any, quantity: str, units: dict[str, str], depth: int = 0
) -> Iterator[tuple[str, list[Any]]]:
    """Yield name and values of the lists of cells, and note the units of quantities."""
    if len(list_of(node)) == 1:
        node = node[0]
    if depth > DEEPEST:
        return
    for name, each in object_of(node).items():
        if name == 'unit':
            units.setdefault(quantity, _unit_of(each))
        elif len(list_of(each)) > 1:
            if not isinstance(each[0], dict | list):
                yield (quantity if name in _OF_QUANTITY else name), each
            elif {*map(len, map(list_of, each))} <= {3, 4}:
                axes = zip(*each, strict=False)
                yield from (
                    (f'{name}.{axis}', list(of)) for axis, of in zip('xyzw', axes, strict=False)
                )
        else:
            yield from _lists(each, name, units, depth + 1)


def _unit_of(unit: Any) -> str:
    symbol = object_of(unit).get('symbol', unit)
    return text_of(object_of(symbol).get('value', symbol))
