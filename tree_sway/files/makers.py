# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Makers of loggers, stations and services, by the columns of their tables: `makers.csv`.

A row has what a header does not say: units of speeds, accelerations, rates, times and diameters
of stems, and the ``sign`` of accelerations, which is -1 where they point as gravity does, as of
Apple's phones. A unit that is chosen in a program, and so is asked for, is ``?``. A table is a
maker's if it has all ``names``, maybe a ``value`` in the first row of the column ``by``, and maybe
a text ``above`` its header.

A line above the header may tell a scale by a form of `scales.csv`: the size of 1 in a column of
its ``quantity`` in its ``unit``, or with the ``power`` -1 how many are one unit. A ``count of``
one is a whole number. Words in capitals stand for the expressions of `_WORDS`.
"""

from __future__ import annotations

import re
from typing import Any

from tree_sway.files.column_names import folded, name_and_unit
from tree_sway.files.table_file import TextTable
from tree_sway.tables import table_beside

_MAKERS = table_beside(__file__, 'makers.csv')
_WORDS = {
    ' EQUALS ': r'[)\]"]{0,2}\s?[:=,;\t]\s?"?',
    ' PER ': ' ?(?:/|per) ?',
    'COUNT': '(?:lsb|counts?|digits?|bits?)',
    'NUMBER': (
        r'(?<![\d.])((?=[0.][0.,]{0,18}[1-9]|[1-9])'  # above 0
        r'\d{0,9}[.,]?\d{1,18}(?:e-?\d{1,2})?)(?!\.?\d)'
    ),
}
_ANY_WORD = re.compile('|'.join(_WORDS))
_SCALES = [
    (re.compile(_ANY_WORD.sub(lambda word: _WORDS[word[0]], each['form']), re.IGNORECASE), each)
    for each in table_beside(__file__, 'scales.csv')
]


def maker_of(table: TextTable) -> dict[str, Any]:
    """
    Return the row of the first maker that a table fits; empty for a table of none.

    Scales that stand above the header count before its units.
    """
    names = [folded(name_and_unit(column, 'speed')[0]) for column in table.columns]
    last = {folded(column.rpartition('.')[2]) for column in table.columns}  # of a name in groups
    above = '\n'.join(table.above)
    scales = dict[str, str]()
    for form, each in _SCALES:
        if told := form.search(above):
            size = float(told[1].replace(',', '.')) ** each['power']
            scales[each['quantity']] = f'{size:.9g} {each["unit"]}'
    for maker in _MAKERS:
        is_it = (
            set(maker['names'].split()) <= last | set(names) and (maker['above'] or '') in above
        )
        if is_it and maker['by']:
            cells = table.cells(names.index(maker['by']), [0])
            is_it = cells[0].removesuffix('.0') == str(maker['value'])
        if is_it:
            return maker | scales
    return scales
