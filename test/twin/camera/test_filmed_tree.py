# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The filmed tree follows points of a true motion, and what is wrong with some moves nothing."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway.core.run import SwaySimulator
from tree_sway.core.scene import make_simulator
from tree_sway.core.tree import ends_of_poses, tips_of_poses, Tree
from tree_sway.growth import grow
from tree_sway.twin.camera import Camera, FilmedTree, looking
from tree_sway.twin.camera.motion_filter import MotionFilter
from tree_sway.twin.observer import Observer
from tree_sway.twin.steady_filter import stationary_covariance, sway_law

CAMERA = Camera(
    np.array([-9.0, -9.0, 1.5]), looking(np.pi / 4, 0.15, 0.0), 900.0, np.array([640.0, 360.0])
)
RATE, SECONDS = 60, 12.0
CALM = np.zeros(3)


@pytest.fixture(scope='module')
def tree() -> Tree:
    return grow('spruce', 5.0, rng=np.random.default_rng(8))


@pytest.fixture(scope='module')
def film(tree: Tree) -> tuple[np.ndarray, np.ndarray]:
    """Return tips of the model in gusts, (n, b, 3), and points of its wood, (n, k, 2)."""
    true = make_simulator(tree)
    rng = np.random.default_rng(1)
    # Of a spruce most points are hidden or crossed; the matching drops those.
    segment = np.concatenate([np.arange(int(tree.branch_first[1])), rng.choice(400, 150)])
    away = 0.5 * tree.length[segment]
    tips, points = [], [CAMERA.project(ends_of_poses(true.place()[segment], away)[1])]
    for k in range(round(SECONDS * RATE)):
        time = k / RATE
        wind = [6.0 + 3.0 * np.sin(1.7 * time), 2.0 * np.sin(0.9 * time), 0.0]
        true.step(wind, 1.0 / RATE)
        poses = true.place()
        tips.append(tips_of_poses(tree, poses))
        points.append(CAMERA.project(ends_of_poses(poses[segment], away)[1]))
    noise = 0.1 * rng.normal(size=np.shape(points))
    return np.array(tips), np.array(points) + noise


def followed(filmed: FilmedTree, points: np.ndarray, late: int = 0, every: int = 2) -> np.ndarray:
    """Tips of a filmed tree without wind, (n, b, 3), whose pictures come some steps late."""
    tips = []
    filmed.film(0.0, 0, points[0])
    for k in range(1, len(points)):
        if k > late and (k - late) % every == 0:
            filmed.film((k - late) / RATE, 0, points[k - late])
        filmed.step(CALM, 1.0 / RATE)
        tips.append(tips_of_poses(filmed.tree, filmed.place()))
    return np.array(tips)


def error(found: np.ndarray, true: np.ndarray, rest: np.ndarray) -> float:
    """Error of the tips, lean and all, over their motion."""
    half = len(true) // 2
    wrong, motion = (found - true)[half:], (true - rest)[half:]
    return float(np.sqrt(np.square(wrong).sum() / np.square(motion).sum()))


def rest_of(simulator: SwaySimulator) -> np.ndarray:
    simulator.reset()
    return tips_of_poses(simulator.tree, simulator.place())


def test_without_wind_it_follows_lean_and_sway(
    tree: Tree, film: tuple[np.ndarray, np.ndarray]
) -> None:
    true, points = film
    filmed = FilmedTree(tree, camera=CAMERA)
    rest = rest_of(filmed)
    assert error(followed(filmed, points), true, rest) < 0.1
    assert 'points on the tree' in filmed.said
    assert 'lost' not in filmed.said
    assert filmed.refused == 0


def test_a_picture_of_the_end_of_a_step_moves_that_step(
    tree: Tree, film: tuple[np.ndarray, np.ndarray]
) -> None:
    """Sums of steps are rounded: none of two pictures waits for the step after."""
    filmed = FilmedTree(tree, camera=CAMERA)
    filmed.film(0.0, 0, film[1][0])
    for k in range(1, 240):
        filmed.film(k / RATE, 0, film[1][k])
        filmed.step(CALM, 1.0 / RATE)
        assert filmed._seen_at == k / RATE


def test_noise_of_the_points_does_not_make_it_tremble(
    tree: Tree, film: tuple[np.ndarray, np.ndarray]
) -> None:
    true, points = film
    noisy = points + 0.3 * np.random.default_rng(7).normal(size=points.shape)
    found = followed(FilmedTree(tree, camera=CAMERA), noisy)
    half = len(true) // 2
    rough = [np.square(np.diff(each[half:], 2, axis=0)).sum() for each in (found, true)]
    # Without gusts the true motion is smooth. Half of the way to each picture makes it 31.
    assert np.sqrt(rough[0] / rough[1]) < 20.0


def test_motion_of_less_than_a_pixel_is_said(
    tree: Tree, film: tuple[np.ndarray, np.ndarray]
) -> None:
    points = film[1]
    filmed = FilmedTree(tree, camera=CAMERA)
    followed(filmed, points[:1] + 0.2 * np.random.default_rng(4).normal(size=points.shape))
    assert 'less than a pixel tells little' in filmed.said


def test_a_late_picture_corrects_the_past(tree: Tree, film: tuple[np.ndarray, np.ndarray]) -> None:
    true, points = film
    filmed = FilmedTree(tree, camera=CAMERA)
    rest = rest_of(filmed)
    assert error(followed(filmed, points, late=6), true, rest) < 0.15


def test_points_that_move_otherwise_move_nothing(
    tree: Tree, film: tuple[np.ndarray, np.ndarray]
) -> None:
    """A fifth is lost, a fifth wanders off with a shadow, and a bird takes a twentieth."""
    true, points = film
    wrong = points.copy()
    rng = np.random.default_rng(3)
    kind = rng.choice(4, points.shape[1], p=[0.55, 0.2, 0.2, 0.05])
    wrong[30:, kind == 1] = np.nan
    wrong[:, kind == 2] += np.linspace(0.0, 30.0, len(wrong))[:, None, None]
    wrong[200:400, kind == 3] += 40.0
    filmed = FilmedTree(tree, camera=CAMERA)
    rest = rest_of(filmed)
    assert error(followed(filmed, wrong), true, rest) < 0.15
    told = filmed.filter.weights / np.square(filmed.filter.errors)
    shadowed = np.isin(filmed.points.row, np.flatnonzero(kind == 2))
    # Across a limb along which the shadow goes nothing moves.
    dragged = np.abs(filmed._axes[shadowed] @ [0.7, 0.7]) > 0.2
    assert told[shadowed][dragged].max() < 0.02 * np.median(told[told > 0.0])


def test_without_pictures_it_goes_on_in_the_wind_alone(
    tree: Tree, film: tuple[np.ndarray, np.ndarray]
) -> None:
    _, points = film
    filmed, alone = FilmedTree(tree, camera=CAMERA), make_simulator(tree)
    filmed.reset()
    followed(filmed, points[:200])
    moved = tips_of_poses(tree, filmed.place()) - tips_of_poses(tree, alone.place())
    assert np.abs(moved).max() > 0.01
    for _ in range(30 * RATE):
        filmed.step(CALM, 1.0 / RATE)
        alone.step(CALM, 1.0 / RATE)
    apart = tips_of_poses(tree, filmed.place()) - tips_of_poses(tree, alone.place())
    assert np.abs(apart).max() < 1e-4


def test_pictures_that_tell_nothing_are_refused_and_said(tree: Tree) -> None:
    filmed = FilmedTree(tree, camera=CAMERA)
    assert 'no picture' in filmed.said
    filmed.film(0.0, 0, np.full((30, 2), 3.0))  # of the sky
    filmed.film(0.5 / RATE, 0, np.full((30, 2), np.nan))
    for _ in range(3):
        filmed.step(CALM, 1.0 / RATE)
    assert filmed.refused == 2
    assert 'too few: check the clicks' in filmed.said
    assert np.isfinite(filmed.place()).all()


def test_old_pictures_are_refused(tree: Tree, film: tuple[np.ndarray, np.ndarray]) -> None:
    _, points = film
    filmed = FilmedTree(tree, camera=CAMERA)
    followed(filmed, points[:120])
    filmed.film(0.3, 0, points[18])
    filmed.step(CALM, 1.0 / RATE)
    assert filmed.refused == 1


def test_a_shake_of_all_that_is_behind_the_tree_is_said(
    tree: Tree, film: tuple[np.ndarray, np.ndarray]
) -> None:
    """Noise, and a cloud that drifts, are no shake."""
    rng = np.random.default_rng(6)
    time = np.arange(len(film[1])) / RATE
    behind = rng.uniform([900.0, 20.0], [1200.0, 300.0], (12, 2)) + np.zeros((len(time), 1, 2))
    drifting = behind + 20.0 * time[:, None, None] + 0.3 * rng.normal(size=behind.shape)
    shake = np.stack([0.8 * np.sin(11.0 * time), 0.5 * np.sin(9.0 * time)], axis=1)[:, None]
    for moved, points in ((drifting, film[1]), (behind + shake, film[1] + shake)):
        filmed = FilmedTree(tree, camera=CAMERA)
        followed(filmed, np.concatenate([points, moved], axis=1))
        assert ('camera shakes' in filmed.said) == (moved is not drifting)
    assert filmed.shake == pytest.approx(0.67, abs=0.1)


@pytest.mark.parametrize('shaken', [0.0, 0.8])
def test_a_shake_of_the_foot_is_said_where_nothing_is_behind_the_tree(
    tree: Tree, film: tuple[np.ndarray, np.ndarray], shaken: float
) -> None:
    """A page sends points of the wood alone."""
    shake = shaken * np.sin(11.0 * np.arange(len(film[1])) / RATE)
    filmed = FilmedTree(tree, camera=CAMERA)
    points = film[1] + np.stack([shake, 0.5 * shake], axis=1)[:, None]
    followed(filmed, points[: 5 * RATE])
    assert ('camera shakes' in filmed.said) == (shaken > 0.0)


def test_few_pictures_and_points_found_anew_are_said(
    tree: Tree, film: tuple[np.ndarray, np.ndarray]
) -> None:
    filmed = FilmedTree(tree, camera=CAMERA)
    followed(filmed, film[1], every=2)
    assert 'are few' not in filmed.said
    assert 'anew' not in filmed.said
    filmed = FilmedTree(tree, camera=CAMERA)
    followed(filmed, film[1], every=12)
    assert '5 pictures a second are few' in filmed.said
    filmed.film(SECONDS + 1.0 / RATE, 1, film[1][-1])
    filmed.step(CALM, 1.0 / RATE)
    assert 'points were found anew' in filmed.said


def test_a_sensor_moves_nothing_while_the_camera_sees_and_all_of_it_without(
    tree: Tree, film: tuple[np.ndarray, np.ndarray], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A sensor that errs makes no good camera worse."""
    _, points = film
    alone = followed(FilmedTree(tree, camera=CAMERA), points)
    moved = np.zeros((3, 32))
    moved[0, 0] = 0.05
    monkeypatch.setattr(Observer, 'step', lambda *_: moved)
    filmed = FilmedTree(tree, camera=CAMERA)
    np.testing.assert_allclose(followed(filmed, points), alone, atol=1e-3)
    for _ in range(30 * RATE):
        filmed.step(CALM, 1.0 / RATE)
    assert abs(filmed._swing[0][0] - 0.05) < 1e-3


def test_the_filter_is_the_least_squares_of_points_and_prior() -> None:
    """One picture of good points: the state is that of the normal equations."""
    rng = np.random.default_rng(2)
    n, p = 4, 30
    law = sway_law(np.geomspace(9.0, 90.0, n), np.full(n, 0.5), np.eye(n), 1.0, 1.0 / 240.0)
    prior = stationary_covariance(law)
    found = MotionFilter(law, prior)
    found.begin(p)
    slopes = rng.normal(size=(p, 2, n))
    eta = 0.01 * rng.normal(size=n)
    found.see(slopes, slopes @ eta)
    rows = slopes.reshape(-1, n)
    weight = found.weights.ravel() / (6.0 * 0.5**2)
    inverse = np.linalg.inv(prior[:n, :n])
    wanted = np.linalg.solve(inverse + (rows.T * weight) @ rows, (rows.T * weight) @ rows @ eta)
    np.testing.assert_allclose(found.state[0], wanted, rtol=1e-9)
    wanted_left = np.linalg.inv(inverse + (rows.T * weight) @ rows)
    np.testing.assert_allclose(found.covariance[:n, :n], wanted_left, rtol=1e-8, atol=1e-14)


def test_a_point_that_errs_along_its_limb_tells_across_it() -> None:
    rng = np.random.default_rng(2)
    n, p = 4, 30
    law = sway_law(np.geomspace(9.0, 90.0, n), np.full(n, 0.5), np.eye(n), 1.0, 1.0 / 240.0)
    found = MotionFilter(law, stationary_covariance(law))
    found.begin(p)
    slopes = 30.0 * rng.normal(size=(p, 2, n))
    eta = 0.1 * rng.normal(size=n)
    for _ in range(300):
        found.see(slopes, slopes @ (eta - found.state[0]) + [2.0, 0.05] * rng.normal(size=(p, 2)))
    along, across = found.errors.mean(axis=0)
    assert along == pytest.approx(2.0, rel=0.3)
    assert across < 0.1
    np.testing.assert_allclose(found.state[0], eta, atol=2e-3)


@pytest.mark.parametrize('strength', [0.3, 1.0, 9.0])
def test_how_strong_unknown_forces_are_is_found(strength: float) -> None:
    rng = np.random.default_rng(5)
    n, p = 6, 40
    law = sway_law(np.geomspace(20.0, 300.0, n), np.full(n, 0.5), np.eye(n), 0.5, 1.0 / 240.0)
    found = MotionFilter(law, stationary_covariance(law))
    found.begin(p)
    slopes = 300.0 * rng.normal(size=(p, 2, n))
    state = np.zeros((3, n))
    for _ in range(1200):
        for _ in range(8):
            state = np.einsum('ijn,jn->in', law.step, state)
            state[2] += np.sqrt(strength * np.diag(law.driven)) * rng.normal(size=n)
        found.advance(8)
        found.see(slopes, slopes @ (state[0] - found.state[0]) + 0.1 * rng.normal(size=(p, 2)))
    assert found.strength == pytest.approx(strength, rel=0.4)
