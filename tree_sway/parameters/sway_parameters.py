# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What commands, pages and nodes let people choose of the sway and of the simulated wind."""

from __future__ import annotations

from tree_sway.core.simulator.settings import MODELS, MOST, Settings
from tree_sway.parameters.parameter import Parameter

MODEL = Parameter(
    'model',
    str(Settings().model),
    'Number of coordinates that the tree has in the wind, 0 to stand still; `branch`, each branch '
    'by itself; `full`, all coordinates and the load of every branch; or `auto`, as few as keep '
    'within tolerance and budget.',
    choices=MODELS,
    most=MOST,
    source="`branch` is the paper's",
)
TOLERANCE = Parameter(
    'tolerance',
    0.005,
    'Largest error of the tips in the model `auto`, without a `camera`.',
    'm',
    1e-6,
    10.0,
    live=True,
)
DAMPING_RATIO = Parameter(
    'damping_ratio',
    0.0,
    "Damping ratio of every branch; 0 for its species' own.",
    '',
    0.0,
    1.0,
    live=True,
)
MEAN_SPEED = Parameter('mean_speed', 6.0, 'Mean wind speed.', 'm/s', 0.0, 40.0, live=True)
BEARING_TO = Parameter(
    'bearing_to',
    1.5708,
    'Bearing that the wind blows to, clockwise from north: a westerly.',
    'rad',
    -6.3,
    6.3,
    live=True,
)
INTENSITY = Parameter(
    'intensity',
    0.2,
    'Turbulence intensity: the standard deviation along the wind over its mean.',
    '',
    0.0,
    1.0,
    live=True,
)
