# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The headers of the native core, as tests compare its callers with them."""

from __future__ import annotations

import math
from pathlib import Path
import re

NATIVE = Path(__file__).parents[2] / 'native'


def code_of(name: str) -> str:
    """Return a header without its comments; empty where the sources are not here."""
    path = NATIVE / name
    text = path.read_text(encoding='utf-8') if path.is_file() else ''
    return re.sub(r'/\*.*?\*/', '', text, flags=re.S)


HEADER = code_of('sway.h')
LIBRARY_HEADER = code_of('library.h')


def number_of(name: str) -> int:
    """Return a number that the library's header names."""
    return int(re.search(rf'enum {{ {name} = (\d+) }};', LIBRARY_HEADER)[1])


def fields_of(structure: str) -> list[tuple[str, bool, int]]:
    """Return name, whether it is a number, and count of each field of a structure."""
    body = LIBRARY_HEADER.partition(f'struct {structure} {{')[2].partition('}')[0]
    body = body.replace('SWAY_RING', str(number_of('SWAY_RING')))
    found = []
    for line in filter(None, map(str.strip, body.split(';'))):
        of, names = re.match(r'((?:const )?\w+\b(?: \*const)?) ?(.*)', line, re.S).groups()
        for name in names.split(','):
            sizes = [int(each) for each in re.findall(r'\[(\d+)\]', name)]
            is_number = of == 'double' and '*' not in name
            found.append((re.search(r'\w+', name)[0], is_number, math.prod(sizes)))
    return found
