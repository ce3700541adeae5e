# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Structures of ``native/library.h``: numbers, and where the arrays of a caller begin."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.native.library import address

FIELDS = {
    'sway_sensed': 'coordinates corrected rows by_state air_damping sensed still',
    'sway_sensor': 'ring mounting kept kept_computed moved',
    'sway_filter': 'coordinates measurements lag law sensed gain deviation row state calm'
    ' innovations sizes',
    'sway_correction': 'coordinates stiffness wanted trust moved energies',
    'sway_dragged': 'coordinates corrected law drag trust state',
}
"""Fields of each; a test compares them with the header."""


class Structure:
    """
    A structure, which keeps its arrays.

    Parameters
    ----------
    name
        Its name, one of `FIELDS`.
    **fields
        A number or a contiguous array for each field.

    """

    def __init__(self, name: str, **fields: int | NDArray[Any]) -> None:
        self._kept = [fields[each] for each in FIELDS[name].split()]
        self._memory = np.array([_word(each) for each in self._kept], dtype=np.int64)
        self.at = address(self._memory)
        """Where it is."""


def _word(field: int | NDArray[Any]) -> int:
    if isinstance(field, int):
        return field
    assert field.flags.c_contiguous
    return address(field)
