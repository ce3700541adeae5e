# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A tree taken through a wind in one call: tips, moment and strain, and what is refused."""

from __future__ import annotations

from dataclasses import replace
import io
import sys
from types import SimpleNamespace

from drawn_trees import SETTINGS, weeping, WOOD
import numpy as np
import pytest
from scipy.integrate import trapezoid

from tree_sway.core.run.simulator import SwaySimulator
from tree_sway.core.scene.make import make_simulator
from tree_sway.core.setup.preparation import prepare
from tree_sway.core.species.species import species_named
from tree_sway.core.wind.turbulence import simulate_turbulence
from tree_sway.errors import ParameterError
from tree_sway.files.trees import open_tree
from tree_sway.simulation.rig import Rig, simulate

STEADY = np.tile([3.0, 0.0, 0.0], (1200, 1))


@pytest.mark.parametrize('model', ['branch', 12, 'full'])
def test_the_base_carries_the_moment_of_a_steady_wind(stem, model):
    """A lone stem at rest in wind: the wood carries what the wind exerts about the root."""
    tree = stem(base=0.03, tip=0.015, cuts=12)
    changes = {'gravity': 0.0, 'damping_ratio': 0.5, 'enrich': 'stem'}
    record = simulate(tree, STEADY, model=model, **changes)
    simulator = make_simulator(tree, species_named(tree.species), model=model, **changes)
    for wind in STEADY:
        simulator.step(wind, 1 / 60)
    assert record.base_moment[-1] == pytest.approx(simulator.wind_moment, rel=0.01, abs=1e-6)
    assert record.tips[-1, 0, 0] > 0.0
    radius, moment = 0.015, record.base_moment[-1, 1]
    bending = species_named(tree.species).modulus * np.pi / 4 * radius**3
    assert record.base_strain[-1] == pytest.approx([-moment / bending, 0.0], rel=1e-6, abs=1e-9)


def test_a_tree_that_carries_others_carries_their_moment_too(fork):
    tree = fork()
    changes = {'gravity': 0.0, 'damping_ratio': 0.5}
    record = simulate(tree, STEADY, model='full', **changes)
    simulator = make_simulator(tree, species_named(tree.species), model='full', **changes)
    for wind in STEADY:
        simulator.step(wind, 1 / 60)
    assert record.base_moment[-1, 1] == pytest.approx(simulator.wind_moment[1], rel=0.05)


def test_a_record_is_cut_into_means_over_steps(stem):
    time = np.arange(0.0, 3.01, 0.5)
    wind = SimpleNamespace(time=time, velocity=np.outer(time, [1.0, 0.0, 0.0]))
    record = simulate(stem(), wind, rate=10.0, seconds=2.0, model=12)
    assert len(record.time) == 20
    assert record.time[-1] == pytest.approx(2.0)
    assert record.wind[:, 0] == pytest.approx(np.arange(20) / 10 + 0.05)


def test_chosen_branches_are_named(fork):
    record = simulate(fork(), STEADY[:5], branches=[0, 2], model=12)
    assert record.tips.shape == (5, 2, 3)
    assert record.branch_names == tuple(fork().branch_names[k] for k in (0, 2))


def test_the_record_as_columns(fork):
    record = simulate(fork(), STEADY[:7], model=12, rate=60.0)
    text = record.to_csv()
    assert text.startswith('time [s],wind_x [m/s],wind_y [m/s],wind_z [m/s],moment_x [N m]')
    read = np.loadtxt(io.StringIO(text), delimiter=',', skiprows=1)
    columns = record.columns()
    assert [*columns][:3] == ['time [s]', 'wind_x [m/s]', 'wind_y [m/s]']
    rows = np.stack([*columns.values()], axis=1)
    assert rows.shape == (7, 13)
    assert read == pytest.approx(rows, rel=1e-8, abs=1e-12)
    assert (rows[:, 7:10] == record.tips[:, 0]).all()
    assert len(repr(record)) < 120
    assert 'mean wind 3 m/s, tip of' in repr(record)
    assert repr(simulate(fork(), STEADY[:5], branches=[], model=12, rate=60.0)).endswith(
        'mean wind 3 m/s'
    )


def test_what_was_made_up_about_the_wind_is_said_of_the_sway(fork):
    wind = SimpleNamespace(time=np.arange(3.0), velocity=STEADY[:3], notes=('made up',))
    assert 'note: made up' in repr(simulate(fork(), wind, model=12))


def test_a_data_frame_has_its_columns(fork, monkeypatch):
    frames = SimpleNamespace(DataFrame=dict)  # of pandas, which the tests do not install
    monkeypatch.setitem(sys.modules, 'pandas', frames)
    record = simulate(fork(), STEADY[:7], model=12, rate=60.0)
    frame = record.to_dataframe()
    assert list(frame) == list(record.columns())
    assert frame['time [s]'] == pytest.approx(record.time)
    assert len(frame['wind_x [m/s]']) == len(record.time) > 0


@pytest.mark.parametrize('model', ['branch', 12, 'auto'])
def test_a_second_wind_finds_the_tree_as_the_first_did(fork, model):
    wind = np.random.default_rng(3).normal([6.0, 0.0, 0.0], 2.0, (60, 3))
    alone, rig = simulate(fork(), wind, model=model), Rig(fork(), model=model)
    rig.run(2.0 * wind)
    again = rig.run(wind)
    assert np.array_equal(again.tips, alone.tips)
    assert np.array_equal(again.base_moment, alone.base_moment)


def record_until(end, start=0.0):
    return SimpleNamespace(time=np.array([start, end]), velocity=np.ones((2, 3)))


@pytest.mark.parametrize(
    ('wind', 'changes', 'words'),
    [
        (np.zeros((0, 3)), {}, r'wind of shape \(0, 3\)'),
        (np.zeros(3), {}, r'wind of shape \(3,\)'),
        (SimpleNamespace(time=np.zeros(1), velocity=np.zeros((1, 3))), {}, 'record of 0 s'),
        (np.full((4, 3), np.nan), {}, 'not finite'),
        (STEADY, {'rate': 0.0}, 'rate: 0.0 is out of range'),
        (STEADY, {'seconds': -1.0}, 'seconds: -1.0 is out of range'),
        (STEADY, {'branches': [7]}, 'branch 7'),
        (STEADY, {'model': 'best'}, "unknown model 'best'"),
        (record_until(2e5), {}, r'200000 s at 60 Hz are 1\.2e\+07 steps; give at most'),
        (record_until(1e300), {}, 'steps; give at most'),
        (record_until(1.7e308, -1.7e308), {}, 'steps; give at most'),
    ],
)
def test_what_cannot_be_simulated_is_refused(stem, wind, changes, words):
    with pytest.raises(ParameterError, match=words):
        simulate(stem(), wind, **changes)


def winds_of(stem, time, velocity, rate):
    """Mean winds that a tree is stepped in through a record."""
    return simulate(stem(), SimpleNamespace(time=time, velocity=velocity), rate=rate, model=2).wind


@pytest.mark.parametrize('step', [0.05, 0.25, 0.5])
def test_means_of_a_record_without_faults_are_those_of_straight_lines(stem, step):
    rng = np.random.default_rng(0)
    wind = simulate_turbulence(6.0, rate=1.0 / step, duration=200.0 * step, rng=rng)
    time = 100.0 + step * np.arange(len(wind))
    frame = 0.4 * step
    means = winds_of(stem, time, wind, 1.0 / frame)
    edges = time[0] + frame * np.arange(len(means) + 1)
    whole = np.array(
        [[trapezoid(*finely(time, column, edge)) for edge in edges] for column in wind.T]
    )
    np.testing.assert_allclose(means, np.diff(whole).T / frame, atol=1e-6)


def finely(time, values, end):
    """Values and times of a line up to an end."""
    until = np.append(time[time < end], end)
    return np.interp(until, time, values), until


@pytest.mark.parametrize('bad', [(np.nan, 0.0, 0.0), (999.99, 0.0, 0.0), (5.0, 60.0, 0.0)])
def test_faults_of_a_record_are_left_out(stem, bad):
    time = np.arange(0.0, 20.0, 0.05)
    wind = np.tile([5.0, 0.0, 0.0], (len(time), 1))
    wind[100:105] = bad
    np.testing.assert_allclose(winds_of(stem, time, wind, 10.0), np.tile([5.0, 0, 0], (199, 1)))


def test_a_gap_of_a_record_is_clamped_then_fades(stem):
    time = np.concatenate([np.arange(0.0, 5.0, 0.05), np.arange(25.0, 30.0, 0.05)])
    means = winds_of(stem, time, np.tile([8.0, 0.0, 0.0], (len(time), 1)), 10.0)[:, 0]
    np.testing.assert_allclose(means[:68], 8.0)
    ends = 0.1 * np.arange(1, len(means) + 1)
    fading = (ends > 7.2) & (ends < 24.8)
    exact = 8.0 * np.exp(-(ends[fading] - 0.05 - 4.95 - 2.0) / 3.0)
    np.testing.assert_allclose(means[fading], exact, atol=0.02)
    np.testing.assert_allclose(means[ends > 25.7], 8.0)  # faded in over half a second


def test_a_record_says_that_steps_stayed_clamped(fork, monkeypatch):
    from tree_sway.core.setup import load_table

    wind = np.tile((9.0, 1.0, 0.0), (200, 1))
    assert simulate(fork(), wind, model=12, rate=60.0, cache=None).notes == ()
    monkeypatch.setattr(load_table, '_MOST_ENERGY', 1e-9)
    record = simulate(fork(), wind, model=12, rate=60.0, cache=None)
    assert 'stayed clamped' in record.notes[0]


def test_a_record_says_how_many_coordinates_were_left_out():
    record = simulate(weeping(3), np.full((9, 3), 2.0), settings=SETTINGS)
    assert ' of 60 coordinates are solved' in ''.join(record.notes)


def test_a_limp_tree_without_inertia_says_so():
    model = prepare(weeping(), WOOD, SETTINGS, model=40)
    rig = Rig(weeping(), model=12)
    rig.simulator = SwaySimulator(replace(model, segment_mass=0.0 * model.segment_mass))
    assert 'no inertia to solve with' in ' '.join(rig.run(np.full((9, 3), 2.0)).notes)


def test_the_share_that_is_done_is_told() -> None:
    told: list[float] = []
    tree = open_tree('benjamina')
    simulate(tree, np.ones((5, 3)), model=3, progress=told.append)
    assert told == pytest.approx([0.2, 0.4, 0.6, 0.8, 1.0])


def test_a_wind_of_steps_without_their_rate_is_noted(fork):
    record = simulate(fork(), STEADY, model=2)
    assert any('60 means per second' in note for note in record.notes)
    assert not any(
        'per second' in note for note in simulate(fork(), STEADY, model=2, rate=60).notes
    )


def test_a_band_without_sensors_says_about_which_motion_it_lies(fork):
    of_one_wind, of_gusts = (
        simulate(fork(), STEADY, model=2, rate=60.0, band=True, crown_coherence=coherence).notes
        for coherence in (1.0, 0.2)
    )
    assert any('crown_coherence 0.3' in note for note in of_one_wind)
    assert not any('crown_coherence' in note for note in of_gusts)


def test_a_record_says_whether_its_tree_was_in_leaf(fork):
    told = [str(simulate(fork(), STEADY, model=2, in_leaf=leaves)) for leaves in (False, True)]
    assert ', bare, ' in told[0]
    assert ', in leaf, ' in told[1]
