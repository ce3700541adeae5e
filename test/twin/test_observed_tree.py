# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A tree with a sensor follows the real one; bad sensors do not move it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache
import os
from pathlib import Path
import subprocess
import sys
import tracemalloc
from typing import Any, NamedTuple

import numpy as np
import pytest
from scipy.signal import detrend
from scipy.spatial.transform import Rotation
from tree_sway_lab.twin.simulated_sensor import SensedMotion, SimulatedSensor

from tree_sway.core.arrays import Floats
from tree_sway.core.run.tuning import Tuning
from tree_sway.core.scene.make import make_simulator
from tree_sway.core.species.species import species_named
from tree_sway.core.tree.segment_frame import ends_of_poses
from tree_sway.core.tree.tree import tips_of_poses
from tree_sway.core.wind.turbulence import simulate_turbulence
from tree_sway.errors import ParameterError
from tree_sway.growth.growing import grow
from tree_sway.twin import later_work
from tree_sway.twin.observed_tree import ObservedTree
from tree_sway.twin.sensor_place import place_on
from tree_sway.twin.sensor_report import sensor_reports
from tree_sway.twin.tree_fit import TreeFit

DT, SECONDS = 1.0 / 60.0, 70
LEARNED = 30 * 60
"""Steps after which a mounting was found for the second time, the third being far."""
TREE, SPECIES = grow('spruce', 5.0, rng=np.random.default_rng(8)), species_named('spruce')
AT = f'{TREE.branch_names[0]}:0.6'
BANDED = list(range(0, TREE.n_branches, 12))
"""Branches whose bands are looked at."""
FIRST = 40 * 60
"""Step from which motion is kept: the mounting is found from the first 20 s and then better."""


class Truth(NamedTuple):
    """Wind (n, 3), tips from FIRST on (m, b, 3), and poses of the place of the sensor (n, 7)."""

    wind: Floats
    tips: Floats
    poses: Floats


@cache
def truth() -> Truth:
    """Sway a tree of softer wood and more damping, in gusts that reach it limb by limb."""
    softer = replace(SPECIES, modulus=0.85 * SPECIES.modulus)
    sim = make_simulator(
        TREE, softer, in_leaf=False, damping_ratio=0.06, crown_coherence=0.3, model=90
    )
    rng = np.random.default_rng(17)
    wind = simulate_turbulence(6.0, rate=60.0, duration=SECONDS, rng=rng)
    place = place_on(TREE, AT)
    away = place.along * TREE.length[place.segment]
    poses, tips = np.empty((len(wind), 7)), np.empty((len(wind) - FIRST, TREE.n_branches, 3))
    block = np.empty((TREE.n_segments, 7))
    for k, each in enumerate(wind):
        sim.step(each, DT)
        sim.place(block)
        poses[k] = block[place.segment]
        poses[k, :3] = ends_of_poses(block[place.segment : place.segment + 1], [away])[1][0]
        if k >= FIRST:
            tips[k - FIRST] = tips_of_poses(TREE, block)
    return Truth(wind, tips, poses)


@cache
def measured(gravity: bool = True) -> SensedMotion:
    mount = Rotation.from_euler('xyz', [160.0, 20.0, -70.0], degrees=True)
    rng = np.random.default_rng(18)
    sensor = SimulatedSensor(mount, has_gravity=gravity)
    return sensor.measured(truth().poses, DT, rng)


class Replay(NamedTuple):
    """
    A tree after a record, and from FIRST on what it showed.

    Its tips, (m, b, 3), its band, and that of the highest tip's distance.
    """

    twin: ObservedTree
    tips: Floats
    band: Floats
    sway_band: Floats


def replayed(
    motion: SensedMotion | None, *, learns: bool = False, seconds: int = SECONDS
) -> Replay:
    twin = ObservedTree(
        TREE, SPECIES, in_leaf=False, at={'phone': AT}, learns=learns, has_band=True
    )
    wind, block = truth().wind[: seconds * 60], np.empty((TREE.n_segments, 7))
    kept = len(wind) - FIRST
    tips = np.empty((kept, TREE.n_branches, 3))
    band = np.empty((kept, 2, len(BANDED), 3))
    sway_band = np.empty((kept, 2))
    first = 0
    for k, each in enumerate(wind):
        while motion is not None and first < len(motion.time):
            if motion.time[first] > (k + 1) * DT + 1e-9:
                break
            twin.offer(
                'phone', motion.time[first], acceleration=motion.acceleration[first],
                rate=motion.rate[first],
            )  # fmt: skip
            first += 1
        twin.step(each, DT)
        if (row := k - FIRST) < 0:
            continue
        tips[row] = tips_of_poses(TREE, twin.place(block))
        band[row] = twin.band(BANDED)
        sway_band[row] = twin.sway_band()
    return Replay(twin, tips, band, sway_band)


def dynamic_error(tips: Floats) -> float:
    """Return the error of the motion about its mean, over the true motion."""
    true = truth().tips[: len(tips)]
    motion, wrong = true - true.mean(axis=0), tips - true
    wrong = wrong - wrong.mean(axis=0)
    return float(np.sqrt(np.square(wrong).sum() / np.square(motion).sum()))


@cache
def good() -> Replay:
    return replayed(measured())


@cache
def learning() -> Replay:
    return replayed(measured(), learns=True)


@cache
def alone() -> Replay:
    return replayed(None)


def test_a_sensor_takes_most_of_the_error_away() -> None:
    twin, tips, *_ = good()
    error, without = dynamic_error(tips), dynamic_error(alone().tips)
    assert error < 0.6 * without
    assert not twin.problems
    counts = twin.sensors['phone'].counts
    assert counts.accepted == len(truth().wind)
    assert counts.refused == counts.disagreed == counts.clamped == 0


def test_the_motion_is_hardly_rougher_than_the_true_one() -> None:
    rough = [np.square(np.diff(each, 2, axis=0)).sum() for each in (good().tips, truth().tips)]
    assert np.sqrt(rough[0] / rough[1]) < 2.5


def test_a_sensor_without_gravity_and_upside_down_does_as_well() -> None:
    twin, tips, *_ = replayed(measured(gravity=False))
    assert not twin.problems
    assert dynamic_error(tips) < 0.75 * dynamic_error(alone().tips)


def test_without_samples_it_moves_in_the_wind_alone() -> None:
    twin, tips, *_ = alone()
    assert twin.problems == ['phone: no sample yet']
    assert np.isfinite(tips).all()


def test_a_silent_sensor_is_counted_and_its_correction_fades() -> None:
    motion = measured()
    kept = motion.time < 50.0
    short = SensedMotion(*(each[kept] for each in motion))
    twin, tips, *_ = replayed(short, seconds=60)
    assert twin.sensors['phone'].counts.silent == 1
    assert 'silent' in twin.problems[0]
    after = slice(54 * 60 - FIRST, len(tips))
    np.testing.assert_allclose(tips[after], alone().tips[after], atol=1e-3)


def test_in_a_calm_a_tree_does_not_follow_the_noise_of_its_sensor() -> None:
    twin = ObservedTree(TREE, SPECIES, model=30, in_leaf=False, at={'phone': AT})
    motion, rng, moved = measured(), np.random.default_rng(19), list[Floats]()
    still = motion.acceleration.mean(axis=0)
    block = np.empty((TREE.n_segments, 7))
    for k in range(105 * 60):
        is_calm = k >= 35 * 60
        felt = still + 0.03 * rng.normal(size=3) if is_calm else motion.acceleration[k]
        turning = 0.004 * rng.normal(size=3) if is_calm else motion.rate[k]
        twin.offer('phone', (k + 1) * DT, acceleration=felt, rate=turning)
        twin.step((0.4, 0.0, 0.0) if is_calm else truth().wind[k], DT)
        if k == 35 * 60:
            assert twin.observer.trust.any()
        moved.append(tips_of_poses(TREE, twin.place(block))[0])
    gusty, calm = (
        detrend(moved[rows], axis=0).std(axis=0).max()
        for rows in (slice(1500, 2100), slice(-600, None))
    )
    assert calm < 0.02 * gusty


def test_a_sensor_that_comes_loose_is_refused() -> None:
    motion = measured()
    turned = motion.acceleration.copy()
    loose = motion.time > 50.0
    turned[loose] = turned[loose][:, [1, 2, 0]]
    twin, tips, *_ = replayed(motion._replace(acceleration=turned), seconds=62)
    assert twin.sensors['phone'].counts.disagreed >= 1
    assert twin.problems
    after = slice(56 * 60 - FIRST, len(tips))
    np.testing.assert_allclose(tips[after], alone().tips[after], atol=5e-3)


def test_a_sensor_that_is_knocked_is_followed_again() -> None:
    motion = measured()
    shaken = motion.acceleration.copy()
    knocked = (motion.time > 46.0) & (motion.time < 46.5)
    shaken[knocked] *= np.where(np.arange(knocked.sum()) % 2, 8.0, -8.0)[:, None]
    twin, *_ = replayed(motion._replace(acceleration=shaken))
    assert twin.sensors['phone'].counts.disagreed == 1
    assert not twin.problems
    assert twin.observer.is_active


@pytest.mark.parametrize('size', [30.0, 300.0])
def test_a_hostile_sensor_does_not_move_the_tree_beyond_its_storms(size: float) -> None:
    motion = measured()
    rng, shaken = np.random.default_rng(19), motion.acceleration.copy()
    hostile = motion.time > 45.0
    shaken[hostile] += size * np.sign(rng.normal(size=(int(hostile.sum()), 3)))
    sway = size * np.sin(2.0 * np.pi * motion.time[hostile])
    shaken[hostile, 0] += sway
    twin, tips, *_ = replayed(motion._replace(acceleration=shaken), seconds=60)
    storm = make_simulator(TREE, SPECIES, in_leaf=False)
    for _ in range(600):
        storm.step((36.0, 0.0, 0.0), DT)
    rest = TREE.end[TREE.branch_first[1:] - 1]
    farthest = np.linalg.norm(tips_of_poses(TREE, storm.place()) - rest, axis=1).max()
    assert np.linalg.norm(tips - rest, axis=2).max() < 2.0 * farthest
    assert twin.sensors['phone'].counts.disagreed + twin.sensors['phone'].counts.too_large > 0


def test_it_learns_stiffness_and_damping() -> None:
    twin, tips, *_ = learning()
    fit = twin.observer.fit
    assert fit is not None
    assert fit.stiffness == pytest.approx(0.85, abs=0.1)
    assert dynamic_error(tips) < 0.6 * dynamic_error(alone().tips)


class Postponed(NamedTuple):
    """Work that is done when its result is asked for."""

    find: Callable[[], object]

    def result(self) -> object:
        return self.find()


def test_the_motion_does_not_depend_on_when_work_beside_the_steps_is_done(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """As late as can be, by the steps themselves: then it would read what they have changed."""
    monkeypatch.setattr(later_work, 'submit_beside', Postponed)
    _twin, tips, band, _ = replayed(measured(), learns=True)
    np.testing.assert_array_equal(tips, learning().tips)
    np.testing.assert_array_equal(band, learning().band)


def test_a_state_carries_the_correction() -> None:
    twin = ObservedTree(TREE, SPECIES, in_leaf=False, at={'phone': AT})
    for each in truth().wind[:30]:
        twin.step(each, DT)
    state = twin.state()
    twin.step((9.0, 0.0, 0.0), DT)
    after = twin.rotations().copy()
    twin.set_state(state)
    twin.step((9.0, 0.0, 0.0), DT)
    np.testing.assert_array_equal(twin.rotations(), after)


def test_a_bad_wind_is_refused_and_counted() -> None:
    twin = ObservedTree(TREE, SPECIES, in_leaf=False, at={'phone': AT}, has_band=True)
    assert twin.step((np.nan, 0.0, 0.0), DT)
    assert twin.counts.refused == 1
    # The last wind moves the tree: what is known of the wind stays known.
    for wind in ((4.0, 0.0, 0.0), (np.inf, 0.0, 0.0), (6.0, 0.0, 0.0)):
        twin.step(wind, DT)
    assert np.isfinite(twin.band()).all()
    twin.reset()
    assert not twin.rotations().any()


@pytest.mark.parametrize(
    ('name', 'value'),
    [
        ('time', 'x'),
        ('time', None),
        ('time', [0.0, 0.1]),
        ('acceleration', 'x'),
        ('acceleration', np.zeros((3, 2))),
        ('acceleration', np.zeros((9, 3))),
        ('rate', np.zeros(3)),
        ('orientation', np.zeros((3, 3))),
    ],
)
def test_a_record_whose_arrays_do_not_fit_is_refused(name: str, value: Any) -> None:
    twin = ObservedTree(TREE, SPECIES, in_leaf=False, at={'phone': AT})
    record = {'time': np.arange(3.0), 'acceleration': np.zeros((3, 3)), name: value}
    with pytest.raises(ParameterError, match=r'phone: (time|acceleration|rate|orientation): '):
        twin.replay('phone', **record)


def test_models_without_coordinates_are_refused() -> None:
    with pytest.raises(ParameterError, match='motion sensors on model') as caught:
        ObservedTree(TREE, SPECIES, model='branch', at={'phone': AT})
    assert caught.value.cure


def test_the_band_holds_the_real_tree_and_a_sensor_narrows_it() -> None:
    widths = []
    for each in (alone(), good()):
        beyond = (truth().tips - each.tips)[:, BANDED, :2]
        low, high = np.moveaxis(each.band[..., :2], 1, 0)
        held = float(((low <= beyond) & (beyond <= high)).mean())
        # More than 80 %: the drag of this tree is that of the model, and its wood near it.
        assert held > 0.75
        widths.append(np.median(high - low, axis=(0, 1)))
    along, across = widths[1] / widths[0]
    # A sensor does not tell how far the tree leans in its mean, along the wind.
    assert along < 1.0
    assert across < 1.0
    if across >= 0.7:
        pytest.xfail(f'across the wind a sensor leaves {across:.2f} of the band, not below 0.7')


def test_the_band_of_the_sway_holds_that_of_the_real_tree() -> None:
    highest = TREE.branch_of_segment[int(np.argmax(TREE.end[:, 2]))]
    rest = tips_of_poses(TREE, make_simulator(TREE, SPECIES).place())[highest]
    widths = []
    for each in (alone(), good()):
        true, found = (
            np.linalg.norm(tips[:, highest] - rest, axis=1) for tips in (truth().tips, each.tips)
        )
        low, high = each.sway_band.T
        assert np.mean((low <= true - found) & (true - found <= high)) > 0.75
        widths.append(np.median(high - low))
    assert widths[1] < widths[0]


def test_without_a_sensor_the_band_grows_with_the_wind() -> None:
    widths = []
    for speed in (4.0, 8.0):
        twin = ObservedTree(TREE, SPECIES, in_leaf=False, at={}, has_band=True)
        found = []
        for _ in range(600):
            twin.step((speed, 0.0, 0.0), DT)
            low, high = twin.band([0])
            found.append((high - low)[0, 0])
        widths.append(float(np.mean(found[300:])))
    assert widths[0] > 0.0
    # The lean grows with the square of the wind, less as the crown streamlines.
    assert 2.2 < widths[1] / widths[0] < 4.5


def test_a_tree_without_a_band_says_how_to_get_one() -> None:
    twin = ObservedTree(TREE, SPECIES, in_leaf=False, at={})
    with pytest.raises(ParameterError, match='without a band') as caught:
        twin.band()
    assert 'has_band' in str(caught.value.cure)


def test_a_step_with_a_sensor_makes_no_arrays(tmp_path: Path) -> None:
    """In a process of its own: threads of others and what traces lines allocate too."""
    np.savez(tmp_path / 'swayed.npz', truth().wind, *measured())
    script = 'import test_observed_tree as t; t.print_memory_of_steps(*t.np.load({!r}).values())'
    environment = {**os.environ, 'PYTHONPATH': str(Path(__file__).parent)}
    command = [sys.executable, '-c', script.format(str(tmp_path / 'swayed.npz'))]
    ran = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=300)
    assert ran.returncode == 0, ran.stderr
    peak, kept = map(int, ran.stdout.split())
    print(f'peak {peak} B, kept {kept} B')
    assert peak < 5000  # views and numbers
    assert kept < 500


def print_memory_of_steps(wind: Floats, *motion: Floats) -> None:
    """Print the peak of 198 steps over the memory before them, and what they keep [B]."""
    twin = ObservedTree(TREE, SPECIES, in_leaf=False, at={'phone': AT})
    winds = [tuple(each) for each in wind.tolist()]
    samples = list(zip(*(each.tolist() for each in motion), strict=True))

    def sway(first: int, last: int) -> None:
        for k in range(first, last):
            time, acceleration, rate = samples[k]
            twin.offer('phone', time, acceleration=acceleration, rate=rate)
            twin.step(winds[k], DT)

    sway(0, LEARNED)
    assert twin.observer.is_active
    tracemalloc.start()
    sway(LEARNED, LEARNED + 2)
    before = tracemalloc.get_traced_memory()[0]
    tracemalloc.reset_peak()
    sway(LEARNED + 2, LEARNED + 200)
    now, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    print(peak - before, now - before)


FIT = TreeFit(0.8, 1.5, 0.02, 0.1, 1.0, 0.1, 0.1)


def told(fit: TreeFit = FIT, steps: int = 0, **changes: Any) -> ObservedTree:
    """Return a tree whose sensors have told a fit, after a number of steps."""
    twin = ObservedTree(TREE, SPECIES, in_leaf=False, at={'phone': AT}, **changes)
    twin.observer._fit.found = fit
    for _ in range(steps):
        twin.step((5.0, 1.0, 0.0), DT)
    return twin


def goal(twin: ObservedTree) -> Tuning:
    """Return stiffness and damping as they are."""
    return twin.check_tuning()


@pytest.mark.parametrize('bad', [0.0, -1.0, np.nan, np.inf, None, 'x'])
def test_a_step_that_is_refused_changes_nothing(bad: Any) -> None:
    twin = told()
    for each in truth().wind[:30]:
        twin.step(each, DT)
    twin._added[:] = 1e-3
    before = twin.state().values
    for _ in range(3):
        with pytest.raises(ParameterError):
            twin.step((5.0, 0.0, 0.0), bad)
    np.testing.assert_array_equal(twin.state().values, before)


def test_what_a_person_tuned_stays_and_learning_goes_on_from_it() -> None:
    twin = told(steps=600)
    made = twin.models[0].damping_ratio
    twin.tune(stiffness_factor=0.5, damping_ratio=4.0 * made)
    factors, ratios = [], []
    for _ in range(4):
        for _ in range(300):
            twin.step((5.0, 1.0, 0.0), DT)
        factors.append(goal(twin).stiffness_factor)
        ratios.append(goal(twin).damping_ratio / made)
    assert 0.5 <= factors[0] < 0.54
    assert 3.7 < ratios[0] <= 4.0
    assert np.abs(np.diff(np.log([factors, ratios]))).max() < 0.051
    assert factors[-1] > factors[0]
    assert ratios[-1] < ratios[0]


def test_learning_waits_for_a_change_that_is_under_way() -> None:
    twin = told(steps=590)
    twin.tune(stiffness_factor=0.5)
    stiffness = []
    for _ in range(60):  # among them the one with which the model follows
        twin.step((5.0, 1.0, 0.0), DT)
        stiffness.append(twin.observer.stiffness[0])
    assert stiffness[-1] < 0.7 * stiffness[0]
    assert np.abs(np.diff(np.log(stiffness))).max() < 0.06


def test_a_state_carries_what_was_learned() -> None:
    twin = told(steps=700)
    state, then = twin.state(), goal(twin)
    assert then.stiffness_factor == pytest.approx(np.exp(-0.1))
    for _ in range(700):
        twin.step((5.0, 1.0, 0.0), DT)
    after = twin.rotations().copy()
    assert goal(twin) != then
    twin.set_state(state)
    assert goal(twin) == then
    twin.now = 700 * DT
    twin.step((5.0, 1.0, 0.0), DT)
    other = told(steps=701)
    np.testing.assert_allclose(twin.rotations(), other.rotations(), rtol=1e-9, atol=1e-12)
    assert not np.allclose(twin.rotations(), after)


def test_another_rate_does_not_change_what_fits_are_relative_to() -> None:
    twin = told(steps=700)
    made = twin.observer._fit._stiffness.copy()
    twin.set_rate(50.0)
    np.testing.assert_array_equal(twin.observer._fit._stiffness, made)
    assert (twin.observer.stiffness < 0.95 * made).all()
    assert twin.observer.fit == FIT


def test_the_learned_frequency_does_not_follow_the_model() -> None:
    twin = told(steps=700)
    assert goal(twin).stiffness_factor < 0.95
    first, learned = told().learned, twin.learned
    assert first is not None
    assert learned is not None
    assert learned.frequency == pytest.approx(first.frequency, rel=1e-9)


def test_learned_damping_is_that_of_the_real_tree_where_a_ratio_is_given() -> None:
    ratio = 0.25 * SPECIES.damping(False)
    twin = told(FIT._replace(damping=1.0), damping_ratio=ratio)
    learned = twin.learned
    assert learned is not None
    assert learned.of(SPECIES, in_leaf=False).damping(False) == pytest.approx(ratio)


def test_what_a_sensor_measures_no_more_is_reported() -> None:
    twin, motion = ObservedTree(TREE, SPECIES, in_leaf=False, at={'phone': AT}), measured()
    for k, each in enumerate(truth().wind[: 30 * 60]):
        rate = motion.rate[k] if k < 20 * 60 else None
        twin.offer('phone', (k + 1) * DT, acceleration=motion.acceleration[k], rate=rate)
        twin.step(each, DT)
        (report,) = sensor_reports(twin)
        is_said = 'it measures no rate any more: restart it' in report.notes
        assert is_said == (twin.sensors['phone'].quantities == ('acceleration',))
    assert is_said


def test_a_quantity_that_is_no_number_from_the_beginning_is_reported() -> None:
    twin = ObservedTree(TREE, SPECIES, in_leaf=False, at={'phone': AT})
    assert twin.offer('phone', 0.0, acceleration=(0.1, np.nan, 9.8), rate=(0.1, 0.0, 0.2))
    (told,) = notes(twin)
    assert told.startswith('it is used without its acceleration, of which some values are no num')


def test_the_correction_does_not_touch_the_motion_in_the_wind(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    corrected, alone = told(), told()
    correction = np.zeros((3, corrected.observer.count))

    def known(time: float, *_: Any) -> Floats:
        correction[0] = 0.02 * np.sin(9.0 * time)
        correction[1] = 0.18 * np.cos(9.0 * time)
        return correction

    monkeypatch.setattr(corrected.observer, 'step', known)
    for each in truth().wind[:300]:
        for twin in (corrected, alone):
            twin.step(each, DT)
    for one, other, added in zip(corrected._swing[:2], alone._swing, correction, strict=False):
        np.testing.assert_allclose(one[: len(added)] - other[: len(added)], added, atol=1e-12)
        np.testing.assert_allclose(one[len(added) :], other[len(added) :], atol=1e-12)


@pytest.mark.parametrize(
    ('fault', 'cause'),
    [
        ('dead', 'repeats the same numbers'),
        ('silent', 'silent for'),
        ('ahead 60', 'its times are +60.0 s from the steps'),
        ('ahead 0.5', 'its times are +0.5 s from the steps'),
        ('ahead -1', 'its times are -1.0 s from the steps'),
        ('nan', 'some values are no numbers'),
    ],
)
def test_the_true_cause_is_told_within_five_seconds(fault: str, cause: str) -> None:
    twin = ObservedTree(TREE, SPECIES, in_leaf=False, at={'phone': AT})
    motion = measured()
    for k, each in enumerate(truth().wind[: 25 * 60]):
        time, row, is_wrong = (k + 1) * DT, motion.acceleration[k], k >= 20 * 60
        ahead = float(fault.partition(' ')[2] or 0.0) if is_wrong else 0.0
        if is_wrong and fault == 'dead':
            row = motion.acceleration[20 * 60]
        if is_wrong and fault == 'nan':
            row = row * np.nan
        if not (is_wrong and fault == 'silent'):
            twin.offer('phone', time + ahead, acceleration=row)
        twin.step(each, DT)
    assert len(twin.problems) == 1
    assert cause in twin.problems[0]


def test_a_tree_unlike_any_of_its_species_is_told() -> None:
    twin = told(FIT)
    assert not any('check that it is on this tree' in each for each in notes(twin))
    for odd in ({'stiffness': 0.55, 'damping': 2.7}, {'stiffness_error': 0.4}):
        twin = told(FIT._replace(**odd))
        assert any('check that it is on this tree' in each for each in notes(twin))


def notes(twin: ObservedTree) -> tuple[str, ...]:
    (report,) = sensor_reports(twin)
    return report.notes
