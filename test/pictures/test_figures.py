# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A notebook shows trees and records as pictures, and takes them by their names."""

from __future__ import annotations

import base64
import re
import sys

import numpy as np
import pytest

import tree_sway as sway
from tree_sway.files.motion import MotionRecord
from tree_sway.files.wind import WindRecord

SECONDS = np.arange(40) / 10.0
TURNING = np.stack([np.cos(SECONDS), np.sin(SECONDS), 0.0 * SECONDS], axis=1)
WIND = WindRecord(SECONDS, 5.0 * TURNING, 'folder/turning.csv', gust=np.full(40, 7.0))


def lines_of(figure: object) -> dict[str, np.ndarray]:
    """Values of the lines of a figure by their labels."""
    return {each.get_label(): each.get_ydata() for axes in figure.axes for each in axes.lines}


def test_the_figure_of_a_wind_has_its_speed_and_where_it_comes_from() -> None:
    lines = lines_of(WIND.plot())
    assert lines['speed'] == pytest.approx(5.0)
    assert lines['gust'] == pytest.approx(7.0)
    # A wind to the east comes from the west.
    assert lines['comes from'][0] == pytest.approx(270.0)


def test_a_calm_comes_from_nowhere() -> None:
    calm = WindRecord(SECONDS, np.where(SECONDS < 1.0, 0.0, 1.0)[:, None] * TURNING, 'calm.csv')
    shown = np.isfinite(lines_of(calm.plot())['comes from'])
    assert (shown == (SECONDS >= 1.0)).all()


def test_the_figure_of_a_motion_has_what_was_measured_alone() -> None:
    figure = MotionRecord(SECONDS, TURNING, None, None, 'imu.csv').plot()
    assert len(figure.axes) == 1
    assert lines_of(figure)['x'] == pytest.approx(TURNING[:, 0])


def test_a_notebook_shows_a_line_and_a_picture() -> None:
    record = sway.simulate('benjamina', WIND, rate=20.0, seconds=2.0, model=3)
    assert lines_of(record.plot())['east'] == pytest.approx(record.tips[:, 0, 0])
    for each in (record, WIND, sway.open_tree('benjamina'), sway.open_tree('benjamina').tree):
        html = each._repr_html_()
        assert html.startswith(type(each).__name__)
        data = re.search(r'base64,([^"]+)"', html)[1]
        assert base64.b64decode(data).startswith(b'\x89PNG')


def test_a_notebook_shows_a_figure_that_a_cell_ends_with() -> None:
    assert WIND.plot()._repr_png_().startswith(b'\x89PNG')


def test_without_matplotlib_a_notebook_shows_the_line(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, 'matplotlib.figure', None)
    assert WIND._repr_html_() is None


def test_what_is_missing_is_named_with_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    record = sway.simulate('benjamina', WIND, rate=20.0, seconds=1.0, model=3)
    for module in ('matplotlib', 'matplotlib.figure', 'pandas'):
        monkeypatch.setitem(sys.modules, module, None)
    for each in (record, WIND, sway.open_tree('benjamina').tree):
        with pytest.raises(sway.TreeSwayError, match=r'matplotlib.*\[plot\]|matplotlib.*in_venv'):
            each.plot()
    with pytest.raises(sway.TreeSwayError, match=r"'pandas'; .*pip install pandas"):
        record.to_dataframe()


@pytest.mark.parametrize(('name', 'cure'), [('second', "'seconds'"), ('duration', 'seconds')])
def test_a_mistyped_argument_is_told_its_name(name: str, cure: str) -> None:
    with pytest.raises(sway.TreeSwayError, match=f"unknown argument '{name}'; .*{cure}"):
        sway.simulate('benjamina', WIND, **{name: 10})


@pytest.mark.parametrize('wind', [8.0, (8.0, 0.0, 0.0), [8, 0]])
def test_a_number_is_told_what_a_wind_is(wind: object) -> None:
    with pytest.raises(sway.TreeSwayError, match=r'simulate_turbulence.*a minute of 8 m/s to the'):
        sway.simulate('benjamina', wind)


def test_the_wind_that_is_meant_is_asked_for() -> None:
    for call in (sway.read_wind, lambda name: sway.simulate('benjamina', name)):
        with pytest.raises(sway.TreeSwayError, match=r"canopi: no such.*did you mean 'canopy'"):
            call('canopi')


def test_a_tree_and_a_wind_are_taken_by_their_names() -> None:
    named = sway.simulate('benjamina', 'canopy', seconds=1.0, model=3)
    given = sway.simulate(
        sway.open_tree('benjamina'), sway.read_wind('canopy'), seconds=1.0, model=3
    )
    assert np.array_equal(named.tips, given.tips)
    assert '10 m' in repr(sway.simulate('oak', np.ones((5, 3)), model=3))
    with pytest.raises(sway.TreeSwayError, match="did you mean 'benjamina'"):
        sway.simulate('benjmina', 'canopy')


def test_without_a_seed_it_is_the_first() -> None:
    assert np.array_equal(sway.grow('oak', 4.0).end, sway.grow('oak', 4.0, rng=0).end)
    wind = sway.simulate_turbulence(5.0, rate=10.0, duration=5.0)
    assert np.array_equal(wind, sway.simulate_turbulence(5.0, rate=10.0, duration=5.0, rng=0))
