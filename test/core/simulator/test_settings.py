# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Settings: each one out of range is refused by name, with what to give instead."""

from __future__ import annotations

import dataclasses

import pytest

from tree_sway_ros.core.simulator.settings import FIDELITIES, MODELS, Settings
from tree_sway_ros.errors import ParameterError


def test_the_defaults_stand():
    chosen = Settings()
    assert chosen.model == 'modes'
    assert chosen.model in MODELS
    assert chosen.damping_ratio is None
    with pytest.raises(dataclasses.FrozenInstanceError):
        chosen.model = 'frozen'


@pytest.mark.parametrize('model', FIDELITIES)
def test_every_model_can_be_asked_for(model):
    assert Settings(model=model).model == model


@pytest.mark.parametrize(
    ('given', 'message'),
    [
        ({'model': 'fast'}, "unknown model 'fast'; use one of: auto, frozen, branch"),
        ({'stiffness': 'felt'}, "unknown stiffness 'felt'; use one of: beam, volume_rule"),
        ({'enrich': 'some'}, "unknown enrich 'some'; use one of: none"),
        (
            {'stiffness': 'volume_rule', 'model': 'modes'},
            "stiffness: the volume rule on model 'modes'",
        ),
        ({'stiffness': 'volume_rule', 'model': 'coupled'}, "use it on 'branch' or 'subtree'"),
        ({'damping_ratio': -0.1}, 'damping ratio -0.1; give 0 or more'),
        ({'damping_ratio': float('nan')}, 'damping ratio nan'),
        ({'n_modes': 0}, 'n_modes: 0 modes; ask for 1 or more'),
        ({'volume_stiffness': 0.0}, 'volume_stiffness 0.0; give a finite number above 0'),
        ({'volume_damping': float('inf')}, 'volume_damping inf'),
        ({'max_wind': float('nan')}, 'max_wind: nan is out of range'),
        ({'gravity': -9.81}, r'gravity -9.81 m/s\^2; give 0 or more'),
        ({'gravity': float('nan')}, 'gravity nan'),
    ],
)
def test_what_is_out_of_range_is_refused(given, message):
    with pytest.raises(ParameterError, match=message):
        Settings(**given)
