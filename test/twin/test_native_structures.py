# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What the twin lays out for the native core is as its header declares it."""

from __future__ import annotations

import math

from native_headers import fields_of, NATIVE, number_of
import pytest

from tree_sway.twin.sample_ring import _RING, CAPACITY
from tree_sway.twin.sensor_readings import _KEPT, LATEST
from tree_sway.twin.sensor_spectrum import HALVES

pytestmark = pytest.mark.skipif(not NATIVE.is_dir(), reason='the sources are not here')


def test_rings_and_readings_are_those_of_the_header() -> None:
    sizes = {'RING': CAPACITY, 'SLOTS': _KEPT, 'LATEST': LATEST, 'HALVES': HALVES}
    for name, number in sizes.items():
        assert number_of(f'SWAY_{name}') == number
    assert fields_of('sway_ring') == [
        (name, of.base.kind == 'f', math.prod(of.shape)) for name, (of, _) in _RING.fields.items()
    ]
