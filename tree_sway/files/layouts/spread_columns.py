# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Columns of JSON that are lists, beside or far from each other as in CoverageJSON.

Lists called ``data`` or ``values`` are those of the quantity that they are in; its ``unit`` is a
text, or has it as the ``symbol``, maybe in another part of the document.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from tree_sway.files.cell_table import table_of_cells
from tree_sway.files.column_names import rank_of
from tree_sway.files.json_values import DEEPEST, list_of, object_of, text_of
from tree_sway.files.layouts.long import unit_for
from tree_sway.files.table_file import TextTable

_OF_QUANTITY = ('data', 'values')


def spread_table(node: Any, units: Mapping[str, Any], source: str) -> TextTable | None:
    """
    Return the columns as long as that of the time, wherever they are in a node; None without two.

    ``units`` are those that a part of the document beside it tells.
    """
    own: dict[str, str] = {}
    columns = dict(_lists(node, '', own))
    clock = next((name for name in columns if rank_of(name, 'time') is not None), None)
    if clock is None:
        return None
    names = [name for name, values in columns.items() if len(values) == len(columns[clock])]
    if len(names) < 2:
        return None
    rows = zip(*(map(text_of, columns[name]) for name in names), strict=True)
    told = {name: unit for name, unit in units.items() if isinstance(unit, str)} | own
    return table_of_cells(
        names, list(rows), source, units=[unit_for(name, told) for name in names]
    )


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
