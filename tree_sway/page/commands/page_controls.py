# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Controls of a page without ROS, in the order in which it shows them.

`Session.apply` does what they ask. Ranges, units and descriptions of parameters of the nodes are
those of ``sway.yaml``.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from tree_sway.core.species import species_keys
from tree_sway.fidelity import DIAL
from tree_sway.growth import BUILTIN_TREES, OLDEST
from tree_sway.installed_models import installed_models
from tree_sway.live import LiveWind
from tree_sway.page import Choices
from tree_sway.page.leaf_calendar import FIRST_MONTH, LAST_MONTH
from tree_sway.parameters import SWAY
from tree_sway.simulation import RecordedWind, SimulatedWind, WindSource
from tree_sway.stream import Control, PAUSE_AND_RESET, Value

_COUNTS = ('1', '9', '100')
_LOWEST, _HIGHEST = 2.0, 40.0
"""Least and greatest height of a tree that is grown on the page [m]."""
_FARTHEST = 100.0
"""Greatest distance of an anemometer on its slider [m]."""

_LABELS = {
    'mean_speed': 'Wind',
    'intensity': 'Gustiness',
    'bearing_to': 'Blows to',
    'tolerance': 'Tolerance',
    'damping_ratio': 'Damping',
    'model': 'Model',
    'gusts': 'Gusts',
    'anemometer_distance': 'Anemometer away',
}


def page_controls(
    choices: Choices, wind: WindSource, *, is_one_tree: bool = True
) -> tuple[Control, ...]:
    """
    Make the controls of a page.

    Models and number of the trees of a stand are those of its file.
    """
    controls = _of_wind(wind)
    if is_one_tree:
        names = ('auto', *map(str, DIAL), 'branch', *installed_models(), choices.model)
        controls.append(replace(_of('model', choices.model), choices=_once(names)))
    controls += [_of('tolerance'), _of('damping_ratio')]
    away = _of('anemometer_distance', choices.anemometer_distance)
    farthest = max(_FARTHEST, choices.anemometer_distance)  # no farther than one can see
    controls += [_of('gusts', choices.gusts), replace(away, maximum=farthest)]
    controls += _of_tree(choices)
    if is_one_tree:
        counts = _once((*_COUNTS, choices.count))
        controls.append(Control('count', 'Number of trees', choices.count, choices=counts))
    return (*controls, *PAUSE_AND_RESET)


def _of(name: str, value: Value = None) -> Control:
    """Make the control of a parameter of the nodes."""
    return Control.of(SWAY[name], _LABELS[name], value)


def _once(names: Iterable[str]) -> tuple[str, ...]:
    """Return the names in their order, each once."""
    return tuple(dict.fromkeys(names))


def _of_wind(wind: WindSource) -> list[Control]:
    if isinstance(wind, SimulatedWind):
        names = ('mean_speed', 'intensity', 'bearing_to')
        return [_of(name, wind.values[name]) for name in names]
    if isinstance(wind, LiveWind) and wind.lacks_direction:
        return [_of('bearing_to', wind.bearing_to)]
    if isinstance(wind, RecordedWind):
        time = Control(
            'record_time',
            'Time',
            0.0,
            'Of the record.',
            unit='s',
            minimum=0.0,
            maximum=wind.length,
        )
        return [time]
    return []


def _of_tree(choices: Choices) -> list[Control]:
    """Make the controls that choose a tree, and of which kind it grows."""
    trees = (choices.tree, *BUILTIN_TREES, *sorted(species_keys()))
    return [
        Control('tree', 'Tree', choices.tree, 'Tree on the page.', choices=_once(trees)),
        Control(
            'height',
            'Height',
            choices.height,
            'Of a tree to grow.',
            unit='m',
            minimum=_LOWEST,
            maximum=_HIGHEST,
        ),
        Control(
            'age',
            'Age',
            choices.age,
            'Of a tree to grow, in years; 0 for the stem that is usual for the height.',
            minimum=0.0,
            maximum=float(OLDEST),
        ),
        Control(
            'individual',
            'Individual',
            choices.individual,
            choices=tuple(map(str, range(10))),
        ),
        Control(
            'month',
            'Season',
            choices.month,
            'Of a tree to grow: its leaves, also for the wind.',
            minimum=FIRST_MONTH,
            maximum=LAST_MONTH,
        ),
    ]
