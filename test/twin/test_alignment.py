# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Mounting, units and gravity of a sensor, found from what it measures."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tree_sway.twin.alignment import align, GRAVITY, TELLS_LITTLE, turn_onto

N = 3000


def motions(seed: int, height: float = 4.0) -> tuple[np.ndarray, np.ndarray]:
    """Return the motion of a model at a height, with gravity felt and without, (n, 9)."""
    rng = np.random.default_rng(seed)
    time = np.arange(N) / 60.0
    phases = rng.uniform(0.0, 6.0, size=(4, 2))
    tilt = 0.02 * np.sin(2.0 * np.pi * 0.5 * time[:, None] + phases[0])
    tilt += 0.01 * np.sin(2.0 * np.pi * 0.83 * time[:, None] + phases[1])
    with_gravity = np.zeros((N, 9))
    rate = np.gradient(tilt, 1.0 / 60.0, axis=0)
    with_gravity[:, 3:5] = rate
    moved = height * np.gradient(rate, 1.0 / 60.0, axis=0)
    without = with_gravity.copy()
    without[:, 0], without[:, 1] = moved[:, 1], -moved[:, 0]
    with_gravity[:, :3] = without[:, :3]
    with_gravity[:, 0] -= GRAVITY * tilt[:, 1]
    with_gravity[:, 1] += GRAVITY * tilt[:, 0]
    with_gravity[:, 6:8] = without[:, 6:8] = tilt
    return with_gravity, without


def sensed(
    mount: Rotation, *, gravity: bool = True, noise: float = 0.02, height: float = 4.0
) -> np.ndarray:
    """Return what a sensor measures there, whose frame is turned to the tree's by a mount."""
    with_gravity, without = motions(1, height)
    values = (with_gravity if gravity else without).copy()
    values[:, 2] += GRAVITY if gravity else 0.0
    rng = np.random.default_rng(2)
    values[:, :3] = mount.inv().apply(values[:, :3]) + noise * rng.normal(size=(N, 3))
    values[:, 3:6] = mount.inv().apply(values[:, 3:6]) + 0.1 * noise * rng.normal(size=(N, 3))
    values[:, 6:] = np.nan
    return values


MOUNTS = [
    Rotation.identity(),
    Rotation.from_euler('x', 180.0, degrees=True),  # upside down
    Rotation.from_euler('xyz', [70.0, -40.0, 130.0], degrees=True),
]


@pytest.mark.parametrize('mount', MOUNTS)
@pytest.mark.parametrize('gravity', [True, False])
def test_a_mount_is_found_with_and_without_gravity(mount: Rotation, gravity: bool) -> None:
    found = align(sensed(mount, gravity=gravity), *motions(1))
    assert not found.problem
    assert found.has_gravity is gravity
    error = Rotation.from_matrix(found.turn) * mount.inv()
    assert np.degrees(error.magnitude()) < 1.5
    assert found.likeness > 0.9


def test_noise_is_measured() -> None:
    found = align(sensed(MOUNTS[2], noise=0.05), *motions(1))
    assert found.noise[0] == pytest.approx(0.05, rel=0.1)
    assert found.noise[1] == pytest.approx(0.005, rel=0.1)


def test_knocks_and_gaps_are_no_noise() -> None:
    values = sensed(MOUNTS[2], noise=0.05)
    values[N // 2, :3] += 5.0  # a knock
    values[N // 4 :] = np.roll(values[N // 4 :], 40, axis=0)  # the motion of another time
    found = align(values, *motions(1))
    assert found.noise[0] == pytest.approx(0.05, rel=0.1)
    assert found.noise[1] == pytest.approx(0.005, rel=0.1)


def test_units_of_g_and_degrees_are_recognised() -> None:
    values = sensed(MOUNTS[2])
    values[:, :3] /= GRAVITY
    values[:, 3:6] *= 180.0 / np.pi
    found = align(values, *motions(1))
    assert not found.problem
    np.testing.assert_allclose(found.scale, [GRAVITY, np.pi / 180.0])
    assert found.notes == ('acceleration in g', 'angular rate in degrees per second')


def test_an_unknown_unit_is_refused_with_what_to_do() -> None:
    values = sensed(MOUNTS[0])
    values[:, :3] *= 100.0
    assert 'neither gravity in m/s^2 nor in g' in align(values, *motions(1)).problem


def test_a_sensor_that_moves_much_more_is_refused() -> None:
    values = sensed(MOUNTS[0], gravity=False)
    values[:, :6] *= 8.0
    assert 'times as much as the tree' in align(values, *motions(1)).problem


def test_a_sensor_of_other_motion_is_refused() -> None:
    rng = np.random.default_rng(3)
    values = sensed(MOUNTS[0])
    with_gravity, _ = motions(1)
    values[:, :6] = with_gravity[:, :6].std(axis=0) * rng.normal(size=(N, 6))
    values[:, 2] += GRAVITY
    assert 'resembles that of the tree' in align(values, *motions(1)).problem


def test_a_place_that_hardly_moves_is_no_evidence_against_its_sensor() -> None:
    values, (with_gravity, without) = sensed(MOUNTS[0]), motions(1)
    found = align(values, 1e-3 * with_gravity, 1e-3 * without, window=20)
    assert found.problem == TELLS_LITTLE
    # The same sensor where the tree moves it somewhat is not on this tree.
    assert 'times as much' in align(values, 0.1 * with_gravity, 0.1 * without, window=20).problem


NORTH_EAST_DOWN = Rotation.from_matrix([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]])


@pytest.mark.parametrize(
    'world',
    [Rotation.identity(), Rotation.from_euler('z', 60.0, degrees=True), NORTH_EAST_DOWN],
    ids=['east north up', 'without a compass', 'north east down'],
)
@pytest.mark.parametrize('mount', MOUNTS)
def test_an_orientation_may_have_any_azimuth_and_either_upright(
    mount: Rotation, world: Rotation
) -> None:
    reference = (world * mount).as_quat()
    values = np.full((N, 9), np.nan)
    with_gravity, without = motions(1)
    values[:, 6:] = mount.inv().apply(with_gravity[:, 6:])
    found = align(values, with_gravity, without, reference)
    assert not found.problem
    np.testing.assert_allclose(found.turn, mount.as_matrix(), atol=1e-9)
    np.testing.assert_allclose(found.motion(values)[:, 6:], with_gravity[:, 6:], atol=1e-9)


def test_gravity_is_believed_before_an_orientation() -> None:
    values = sensed(MOUNTS[2])
    values[:, 6:] = 0.02 * np.random.default_rng(5).normal(size=(N, 3))
    found = align(values, *motions(1), MOUNTS[1].as_quat())
    assert not found.problem
    error = Rotation.from_matrix(found.turn) * MOUNTS[2].inv()
    assert np.degrees(error.magnitude()) < 1.5


@pytest.mark.parametrize('gravity', [True, False])
@pytest.mark.parametrize('mount', MOUNTS)
def test_an_acceleration_of_the_opposite_sign_is_recognised(
    mount: Rotation, gravity: bool
) -> None:
    values = sensed(mount, gravity=gravity)
    values[:, :3] *= -1.0
    found = align(values, *motions(1))
    assert not found.problem
    assert 'acceleration of the opposite sign' in found.notes
    error = Rotation.from_matrix(found.turn) * mount.inv()
    assert np.degrees(error.magnitude()) < 1.5
    wanted = motions(1)[0 if gravity else 1]
    np.testing.assert_allclose(found.motion(values)[:, :2], wanted[:, :2], atol=0.3)


SIGNS = {
    'acceleration of the opposite sign': [-1.0] * 3 + [1.0] * 3,
    'angular rate of the opposite sign': [1.0] * 3 + [-1.0] * 3,
    'all signs are opposite: its axes are reversed, or left-handed': [-1.0] * 6,
}


@pytest.mark.parametrize('note', SIGNS)
@pytest.mark.parametrize('mount', MOUNTS)
def test_opposite_signs_are_found_where_half_of_the_motion_is_not_the_models(
    mount: Rotation, note: str
) -> None:
    values = sensed(mount)
    other, _ = motions(7)
    for rows in (slice(0, 3), slice(3, 6)):
        values[:, rows] += 0.7 * mount.inv().apply(other[:, rows])
    values[:, :6] *= SIGNS[note]
    found = align(values, *motions(1))
    assert found.notes == (note,)
    assert 0.6 < found.likeness < 0.9
    error = Rotation.from_matrix(found.turn) * mount.inv()
    assert np.degrees(error.magnitude()) < 20.0
    right = values.copy()
    right[:, :6] *= SIGNS[note]
    assert not align(right, *motions(1)).notes


@pytest.mark.parametrize('mount', MOUNTS)
@pytest.mark.parametrize('axis', [0, 1, 2])
def test_a_frame_with_one_axis_mirrored_is_a_turned_one_with_all_reversed(
    mount: Rotation, axis: int
) -> None:
    values = sensed(mount)
    right = align(values, *motions(1)).motion(values)
    values[:, [axis, 3 + axis]] *= -1.0
    found = align(values, *motions(1))
    assert not found.problem
    assert 'left-handed' in found.notes[0]
    np.testing.assert_allclose(found.motion(values)[:, :6], right[:, :6], atol=0.02)


@pytest.mark.parametrize('mount', MOUNTS)
def test_an_acceleration_that_lost_its_mean_still_feels_tilts(mount: Rotation) -> None:
    values = sensed(mount, height=0.3)
    values[:, :3] -= values[:, :3].mean(axis=0)
    found = align(values, *motions(1, 0.3))
    assert not found.problem
    assert found.has_gravity
    assert 'acceleration without its mean, but with the gravity of tilts' in found.notes
    error = Rotation.from_matrix(found.turn) * mount.inv()
    assert np.degrees(error.magnitude()) < 1.5


def test_the_smallest_turn_leads_from_one_direction_to_the_other() -> None:
    rng = np.random.default_rng(4)
    for a, b in [*rng.normal(size=(20, 2, 3)), np.array([[0.0, 0.0, 1.0], [0.0, 0.0, -2.0]])]:
        turn = turn_onto(a, b)
        np.testing.assert_allclose(turn @ turn.T, np.eye(3), atol=1e-9)
        moved = turn @ a / np.linalg.norm(a)
        np.testing.assert_allclose(moved, b / np.linalg.norm(b), atol=1e-6)


SLOW = 8 * 60
"""Steps of 8 s."""


def beside_a_mast(seed: int, seconds: float) -> tuple[np.ndarray, np.ndarray]:
    """Return leans of a tree and of its model, which share slow gusts only, (n, 9)."""
    rng = np.random.default_rng(seed)
    n = round(seconds * 60)
    frequency = np.fft.rfftfreq(n, 1.0 / 60.0)[:, None]
    size = np.minimum(1.0, 0.05 / np.maximum(frequency, 0.02))
    size = size * [1.0, 0.4] / np.abs(1.0 - np.square(frequency) + 0.1j * frequency)
    shared = np.exp(-7.7 * frequency)
    waves = rng.normal(size=(4, len(frequency), 2)) @ [1.0, 1.0j]
    tree = waves[0:2].T
    model = shared * tree + np.sqrt(1.0 - shared**2) * waves[2:4].T
    found = []
    for each in (tree, model):
        tilt = np.fft.irfft(size * each, n, axis=0)
        rows = np.zeros((n, 9))
        rows[:, 3:5] = np.gradient(tilt, 1.0 / 60.0, axis=0)
        rows[:, 6:8] = tilt
        rows[:, 0], rows[:, 1] = -GRAVITY * tilt[:, 1], GRAVITY * tilt[:, 0]
        found.append(rows * 0.01 / tilt.std())
    return found[0], found[1]


def measured_there(tree: np.ndarray, mount: Rotation) -> np.ndarray:
    values = tree.copy()
    values[:, 2] += GRAVITY
    for rows in (slice(0, 3), slice(3, 6)):
        values[:, rows] = mount.inv().apply(values[:, rows])
    values[:, 6:] = np.nan
    return values


@pytest.mark.parametrize('mount', MOUNTS)
def test_the_lean_tells_an_azimuth_where_the_sway_is_that_of_other_gusts(mount: Rotation) -> None:
    errors = []
    for seed in range(12):
        tree, model = beside_a_mast(seed, 240.0)
        found = align(measured_there(tree, mount), model, model, window=SLOW)
        error = (Rotation.from_matrix(found.turn) * mount.inv()).as_rotvec()[2]
        errors.append(error / found.azimuth_error)
        assert not found.problem
        assert not found.notes
    assert np.sqrt(np.mean(np.square(errors))) < 2.0


@pytest.mark.parametrize('mount', MOUNTS)
def test_a_sensor_that_is_told_which_way_it_faces_needs_no_likeness(mount: Rotation) -> None:
    tree, _ = beside_a_mast(1, 60.0)
    other, _ = beside_a_mast(2, 60.0)
    axis = mount.as_matrix()[:, 2]
    if abs(axis[2]) > 0.7:
        axis = mount.as_matrix()[:, 1]
    facing = float(np.arctan2(axis[1], axis[0]))
    found = align(measured_there(tree, mount), other, other, window=SLOW, facing=facing)
    assert not found.problem
    error = Rotation.from_matrix(found.turn) * mount.inv()
    assert np.degrees(error.magnitude()) < 2.0


def test_a_twig_that_hangs_has_a_rate_of_its_own_sign() -> None:
    """Its fast sway, of which it feels the acceleration, leans it the other way."""
    tree, _ = beside_a_mast(1, 60.0)
    values = measured_there(tree, MOUNTS[0])
    time = np.arange(len(values)) / 60.0
    turning = 2.0 * np.pi * 1.5
    sway = np.zeros_like(values)
    sway[:, 0], sway[:, 4] = 3.0 * np.sin(turning * time), 0.3 * np.cos(turning * time)
    for first in (0, 3):
        sway[:, first : first + 3] = MOUNTS[0].inv().apply(sway[:, first : first + 3])
    note = 'angular rate of the opposite sign'
    assert note not in align(values + sway, tree, tree, window=SLOW).notes


@pytest.mark.parametrize('mount', MOUNTS)
def test_a_rate_tells_its_sign_whatever_the_wind(mount: Rotation) -> None:
    tree, _ = beside_a_mast(1, 60.0)
    other, _ = beside_a_mast(2, 60.0)
    values = measured_there(tree, mount)
    note = 'angular rate of the opposite sign'
    assert note not in align(values, other, other, window=SLOW).notes
    values[:, 3:6] *= -1.0
    assert note in align(values, other, other, window=SLOW).notes
