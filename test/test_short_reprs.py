# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A public object prints as one short line that names it."""

from __future__ import annotations

import numpy as np
import pytest

import tree_sway as sway
from tree_sway.files.motion import MotionRecord
from tree_sway.files.wind.record import WindRecord

LONGEST = 240
WIND = np.tile([6.0, 0.0, 0.0], (30, 1))


@pytest.fixture(scope='module')
def objects() -> dict[str, object]:
    file = sway.open_tree('goldcrest')
    placed = [sway.PlacedTree(f'oak {i}', file.tree, x=8.0 * i) for i in range(200)]
    forest = sway.Scene(placed, name='forest')
    simulator = sway.make_simulator(file, model=3)
    return {
        'Tree': file.tree,
        'TreeFile': file,
        'Species': file.species,
        'PlacedTree': placed[1],
        'Scene': forest,
        'Settings': sway.Settings(gravity=0.0, leaf_mass=np.zeros(5000)),
        'SwaySimulator': simulator,
        'AdaptiveSimulator': sway.make_simulator(file, model='auto'),
        'SceneSimulator': sway.Scene(placed[:3], name='row').simulator(model=3),
        'SwayRecord': sway.simulate(file, WIND, model=3, rate=60.0),
        'WindRecord': WindRecord(np.arange(30.0), WIND, 'wind.csv'),
        'MotionRecord': MotionRecord(np.arange(30.0), WIND, None, None, 'imu.csv'),
        'TreeState': simulator.state(),
    }


@pytest.mark.parametrize(
    ('kind', 'words'),
    [
        ('Tree', ['goldcrest', 'segments']),
        ('TreeFile', ['goldcrest', 'segments']),
        ('Species', ['GPa', 'kg/m^3']),
        ('PlacedTree', ['oak 1', '(8, 0, 0) m']),
        ('Scene', ['forest', '200 trees of 1 kind']),
        ('Settings', ['model=60', 'gravity=0.0', 'leaf_mass=<5000 numbers>']),
        ('SwaySimulator', ['goldcrest', 'model 3', '0 steps']),
        ('AdaptiveSimulator', ['goldcrest', 'model auto']),
        ('SceneSimulator', ['row', '3 trees', 'model 3']),
        ('SwayRecord', ['goldcrest', '30 steps']),
        ('WindRecord', ['wind.csv', '30 samples', '6 m/s']),
        ('MotionRecord', ['imu.csv', '30 samples', '29 s', 'acceleration']),
        ('TreeState', ['goldcrest', 'model 3']),
    ],
)
def test_a_public_object_prints_as_one_short_line(
    objects: dict[str, object], kind: str, words: list[str]
) -> None:
    text = repr(objects[kind])
    assert text.startswith(kind)
    assert '\n' not in text
    assert len(text) <= LONGEST
    assert [word for word in words if word not in text] == []


def test_settings_print_what_was_changed_and_the_model() -> None:
    assert repr(sway.Settings()) == 'Settings(model=60)'
    assert eval(repr(sway.Settings(model='full', enrich='stem')), {'Settings': sway.Settings}) == (
        sway.Settings(model='full', enrich='stem')
    )
