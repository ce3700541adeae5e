# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Settings: each one out of range is refused by name, with what to give instead."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from tree_sway.core.scene import make_simulator
from tree_sway.core.settings import MODELS, Settings, USUAL
from tree_sway.core.wind import simulate_turbulence, WindProfile
from tree_sway.errors import ParameterError


def test_the_defaults_stand():
    chosen = Settings()
    assert chosen.model == USUAL
    assert chosen.damping_ratio is None
    with pytest.raises(dataclasses.FrozenInstanceError):
        chosen.model = 0


@pytest.mark.parametrize('model', [*MODELS, 0, 3, 60])
def test_every_model_can_be_asked_for(model):
    assert Settings(model=model).model == model


@pytest.mark.parametrize(
    ('given', 'message'),
    [
        ({'model': 'fast'}, "unknown model 'fast'; use one of: auto, branch, full, or a number"),
        ({'enrich': 'some'}, "unknown enrich 'some'; use one of: none"),
        (
            {'volume_stiffness': 1e5, 'model': 12},
            "volume_stiffness: the volume rule on model '12'",
        ),
        ({'volume_stiffness': 1e5, 'model': 'full'}, "use it on model 'branch'"),
        ({'damping_ratio': -0.1}, 'damping_ratio: -0.1 is out of range; use 0 to 1000'),
        ({'damping_ratio': float('nan')}, 'damping_ratio: nan'),
        ({'model': -1}, "unknown model '-1'"),
        ({'model': 2.5}, "unknown model '2.5'"),
        ({'model': True}, "unknown model 'True'"),
        ({'model': 'ful'}, "did you mean 'full'"),
        ({'volume_stiffness': -1.0}, 'volume_stiffness: -1.0 is out of range'),
        ({'volume_damping': float('inf')}, 'volume_damping: inf'),
        ({'max_wind': float('nan')}, 'max_wind: nan is out of range'),
        ({'gravity': -9.81}, r'gravity: -9.81 is out of range; use 0 to 1000 m/s\^2'),
        ({'gravity': float('nan')}, 'gravity: nan'),
    ],
)
def test_what_is_out_of_range_is_refused(given, message):
    with pytest.raises(ParameterError, match=message):
        Settings(**given)


def test_a_number_may_be_given_as_text():
    assert Settings(model='20') == Settings(model=20)


@pytest.mark.parametrize(
    'whole',
    [
        {'gravity': 0},
        {'root_stiffness': 10**9},
        {'damping_ratio': 1},
        {'max_wind': 40},
        {'anemometer_distance': 12, 'anemometer_bearing': 1},
        {'profile': WindProfile('power', 2)},
    ],
    ids=str,
)
def test_a_whole_number_is_a_number(fork, whole):
    simulator = make_simulator(fork(), model=2, **whole)
    simulator.step(np.ones(3), 1 / 60)


def test_a_bearing_in_degrees_is_refused():
    with pytest.raises(ParameterError, match=r'anemometer_bearing: 270 is out of range.* rad'):
        Settings(anemometer_bearing=270)
    with pytest.raises(ParameterError, match=r'bearing_to: 270 is out of range.* rad'):
        simulate_turbulence(5.0, duration=1.0, bearing_to=270)


def test_settings_are_equal_if_their_arrays_are():
    one, same, other = (Settings(leaf_mass=np.full(3, x)) for x in (1.0, 1.0, 2.0))
    assert one == same
    assert hash(one) == hash(same)
    assert one != other
    assert one != Settings()
    assert one != 'settings'
