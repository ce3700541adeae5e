# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Array types: float64, int64, and records, whose fields a class lists."""

from __future__ import annotations

from typing import Any, get_args, get_type_hints

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Singles = NDArray[np.float32]
Complexes = NDArray[np.complex128]
Ints = NDArray[np.int64]

#: Arrays of structured records, whose fields `core.model.records` lists.
Records = NDArray[np.void]


#: Codes of fields by type.
_CODES = {int: 'i8', float: 'f8', Ints: 'i8', Floats: 'f8', Singles: 'f4'}


def fields_of(record: type, **sizes: int) -> list[tuple[Any, ...]]:
    """
    Return name, code and shape of each field of a record, as `numpy.dtype` takes them.

    Fields are the annotations of a class: a number, or ``Annotated[Floats, ...]`` with its shape;
    ``sizes`` are the numbers for names in the shape.
    """
    fields: list[tuple[Any, ...]] = []
    for name, hint in get_type_hints(record, include_extras=True).items():
        kind, *shape = get_args(hint) or (hint,)
        size = tuple(sizes.get(each, each) for each in shape)
        fields.append((name, _CODES[kind], size) if shape else (name, _CODES[kind]))
    return fields
