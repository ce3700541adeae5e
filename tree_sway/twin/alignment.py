# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
How a sensor is mounted, found from gravity and from the sway itself.

Gravity tells which way is up in the sensor's frame. The azimuth is that by which the sensor's
motion resembles the motion of the model at its place most, in least squares (Wahba 1965, SIAM
Review 7, 409), unless it is told which way the sensor faces. A sensor whose acceleration has no
gravity is turned by the whole of that problem (Kabsch 1976, Acta Crystallographica A 32, 922-923),
unless it has an orientation, which tells what is upright. The azimuth of an orientation is not
believed: without a compass it is any, and steel turns a compass.

A mast some metres away knows the lean in slow gusts, and nothing of those that shake the crown.
So both motions are averaged over some seconds, in which an acceleration is the lean. N averages
whose correlation is r tell an azimuth with the error ``sqrt((1 - r^2) / (2 N r^2))`` of a phase
(Bendat & Piersol 2010, *Random Data*, 9.2), and the sign s of r's rival by ``N ln (1 - r^2) / (1 -
s^2)``, the logarithm of their likelihoods. Where gravity is felt, all of the sway tells it
(`sway_azimuth`).

Units follow from the size of gravity, and of the motion in comparison with the model's. So do the
signs: some phones give the acceleration as that of gravity, and some frames are left-handed. A
rate has the sign by which a lean changes as it says, whatever the wind.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
import math

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.arrays import Floats
from tree_sway.core.rotation import about_up, cross_matrix, quaternion_rotated
from tree_sway.twin.sway_azimuth import Sway, sway_azimuth

GRAVITY = 9.80665
"""Standard gravity in [m/s^2]."""

_MOST_ERROR, _TOLD_ERROR = 0.35, 0.1
"""Largest error of an azimuth with which a sensor is used, and that of one that is told [rad]."""

TELLS_LITTLE = 'it tells little at this place in this wind: fix it higher or farther out on a limb'
"""What a sensor says where the tree hardly moves it."""

LEAST_NOISE = np.array([0.03, 0.004, 0.002])
"""Least noise of acceleration [m/s^2], rate [rad/s] and rotation [rad]."""

_MOST_RATIO = 5.0
_GRAVITY_RANGE = (0.85, 1.15)
_NO_GRAVITY = 0.4
_WITHOUT = 'acceleration without gravity'
_OPPOSITE = 10.0
"""
Logarithm of the likelihoods from which an acceleration is believed to be of opposite sign: leans
of few gusts resemble their mirror images by chance.
"""

_AGAINST = 0.2
"""
Correlation of an angular rate with the change of the lean from which it is believed to be of
opposite sign: on right twigs it was down to -0.04, on limbs and stems it is 0.4 and more.
"""

_SIGNS = {
    (-1.0, 1.0): 'acceleration of the opposite sign',
    (1.0, -1.0): 'angular rate of the opposite sign',
    (-1.0, -1.0): 'all signs are opposite: its axes are reversed, or left-handed',
}
"""Signs of acceleration and angular rate. A mirrored frame is a turned one, all axes reversed."""
_TILTED = 0.1
"""Likeness by which tilted gravity must be better than none in a signal without its mean."""
_UPSIDE_DOWN = np.diag([1.0, -1.0, -1.0])
"""From north, east, down, or another frame whose third axis is down, to one with it up."""
_UPRIGHT = 0.7
"""Cosine of the angle to the vertical below which the z axis of a sensor tells where it faces."""
_PER_DEGREE = math.pi / 180.0
Flags = NDArray[np.bool_]

_MEDIAN_OF_SQUARE = 0.4549
"""Median of the square of a normal variable over its variance (chi-squared, one degree)."""


@dataclass(frozen=True)
class Alignment:
    """
    What is known about a sensor.

    Parameters
    ----------
    turn
        Rotation from the sensor's frame to east, north, up, (3, 3).
    scale
        Factors of acceleration and rate to [m/s^2] and [rad/s], (2,).
    has_gravity
        Whether the acceleration has gravity in it.
    likeness
        Correlation of its motion with the model's in wind alone [-].
    azimuth_error
        Standard deviation of its azimuth [rad].
    noise
        Standard deviation of the noise of a sample: acceleration, rate, rotation, (3,).
    problem
        Why it cannot be used and what to do; empty if it can.
    notes
        Properties that were recognised, one sentence each.

    """

    turn: Floats
    scale: Floats
    has_gravity: bool
    likeness: float
    noise: Floats
    azimuth_error: float = 0.0
    problem: str = ''
    notes: tuple[str, ...] = ()

    def motion(self, values: Floats) -> Floats:
        """
        Turn a sample (..., 9) into the frame of the tree, (..., 9).

        Gravity is taken off the acceleration.
        """
        out = values.copy()
        out[..., :3] = self.scale[0] * values[..., :3] @ self.turn.T
        out[..., 2] -= GRAVITY if self.has_gravity else 0.0
        out[..., 3:6] = self.scale[1] * values[..., 3:6] @ self.turn.T
        out[..., 6:9] = values[..., 6:9] @ self.turn.T
        return out

    def turned(self, angle: float) -> Alignment:
        """Return it turned from east to north by an angle in [rad]."""
        return replace(self, turn=about_up(angle) @ self.turn)


def align(
    sensed: Floats,
    with_gravity: Floats,
    without: Floats,
    reference: Floats | None = None,
    window: int = 1,
    facing: float | None = None,
    sign: float = 0.0,
    sway: Sway | None = None,
    samples: Floats | None = None,
    held: float = 1.0,
) -> Alignment:
    """
    Find the mounting of a sensor.

    Parameters
    ----------
    sensed
        Samples at equal steps: acceleration, rate and rotation, (n, 9), columns that the sensor
        does not measure not a number.
    with_gravity
        Motion of the model there, of a sensor that feels gravity, (n, 9).
    without
        The same of one whose acceleration has no gravity.
    reference
        Orientation from which the rotations are counted, x y z w, in any frame with an upright
        axis; None without.
    window
        Number of steps over which motions are averaged before they are compared.
    facing
        Azimuth to which its z axis points, or its y axis where that is upright, from east to
        north in [rad]; None if it is not told.
    sign
        Sign of its acceleration, 1 or -1; that by which it is more alike if 0.
    sway
        What is known of the sway there, by which a lean tells the azimuth (`sway_azimuth`); None
        without.
    samples
        Its last samples as it sent them, (m, 9), which tell its noise; None if those at equal
        steps are these.
    held
        Steps from one of them to the next [-].

    """
    raw, sensed = sensed, averaged(sensed, window)
    notes = list[str]()
    measures: Flags = np.all(np.isfinite(sensed).reshape(-1, 3, 3), axis=(0, 2))
    given, scale = measures.copy(), np.ones(2)
    has_gravity, problem = True, ''
    if measures[0]:
        scale[0], has_gravity, problem = _gravity_of(sensed[:, :3], notes)
    if measures[0] and has_gravity:
        measures[1:] = False  # gravity tells what is upright, and the lean
    model = averaged(with_gravity if has_gravity else without, window)
    if given[1]:
        scale[1] = _rate_unit(sensed[:, 3:6], model[:, 3:6], notes)

    def mounted(model: Floats, signs: tuple[float, float]) -> Alignment:
        return _mounted(
            sensed, model, measures, scale * signs, reference, facing, has_gravity=has_gravity
        )

    signs = sign or 1.0, 1.0
    found = mounted(model, signs)
    count = max(len(raw) / window, 2.0)
    if measures[0] and not sign:
        opposite = mounted(model, (-1.0, 1.0))
        ratio = (1.0 - found.likeness**2) / max(1.0 - opposite.likeness**2, 1e-12)
        if count * math.log(max(ratio, 1e-12)) > _OPPOSITE:
            signs, found = (-1.0, 1.0), opposite
    if given[:2].all() and _is_against(found.motion(sensed)):
        signs = signs[0], -1.0
        found = mounted(model, signs)
    if signs in _SIGNS:
        notes.append(_SIGNS[signs])
    if measures[0] and not has_gravity:
        felt = averaged(with_gravity, window)
        tilted = mounted(felt, signs)
        if tilted.likeness > found.likeness + _TILTED:
            notes.remove(_WITHOUT)
            notes.append('acceleration without its mean, but with the gravity of tilts')
            # A sample is compared with its mean, so that it does not matter that gravity is off.
            found = replace(tilted, has_gravity=True)
            has_gravity = True
            model = felt
    likeness, ratio = _likeness(found.motion(sensed), model, measures)
    if not problem and measures[0] and not has_gravity and ratio < 1.0 / 3.0:
        notes.append('acceleration in g, without gravity')
        found.scale[0] *= GRAVITY
        likeness, ratio = _likeness(found.motion(sensed), model, measures)
    moved, error = found.motion(raw), _TOLD_ERROR
    noise = noise_of(moved if samples is None else found.motion(samples))
    if facing is None or not has_gravity:
        error = _azimuth_error(likeness, count)
    if sway is not None and facing is None and measures[0] and has_gravity:
        turn, error = sway_azimuth(
            moved[:, :2], with_gravity[:, :2], noise[0] * math.sqrt(held), sway
        )
        found = found.turned(turn)
        likeness, _ = _likeness(found.motion(sensed), model, measures)
    # Any sensor would differ from a model that moves it less than its noise.
    size = np.sqrt(model.var(axis=0).reshape(3, 3).sum(axis=1))
    if not problem and (size < LEAST_NOISE / math.sqrt(window))[measures].all():
        problem = TELLS_LITTLE
    if not problem and not 1.0 / _MOST_RATIO < ratio < _MOST_RATIO:
        problem = (
            f'it moves {ratio:.2g} times as much as the tree does there in this wind: check that '
            'it is on this tree, at this place, in m/s^2 and rad/s'
        )
    if not problem and error > _MOST_ERROR:
        problem = (
            f'its motion resembles that of the tree by {likeness:.2f} only, too little to know '
            'which way it faces: wait for more wind or tell it, check place and clock'
        )
    return replace(
        found, likeness=likeness, noise=noise, azimuth_error=error, problem=problem,
        notes=tuple(notes),
    )  # fmt: skip


def _azimuth_error(likeness: float, count: float) -> float:
    """Error of an azimuth [rad] by the correlation of a number of averages, less its bias."""
    square = (count * likeness**2 - 1.0) / (count - 1.0)
    if likeness <= 0.0 or square <= 0.0:
        return math.pi
    return math.sqrt(max(1.0 - square, 0.0) / (2.0 * count * square))


def _is_against(moved: Floats) -> bool:
    """
    Whether an angular rate turns against the lean that the acceleration tells, (n, 9).

    Turned by theta, a sensor feels ``g z x theta``. What fast sway adds to it has the other sign
    on a twig that hangs, so that motion is to be averaged.
    """
    change = np.gradient(moved[:, :2], axis=0)
    rate = moved[:, 3:5] - moved[:, 3:5].mean(axis=0)
    likeness = (change[:, 1] * rate[:, 0] - change[:, 0] * rate[:, 1]).sum()
    return likeness < -_AGAINST * (np.linalg.norm(change) * np.linalg.norm(rate))


def _mounted(
    sensed: Floats,
    model: Floats,
    measures: Flags,
    scale: Floats,
    reference: Floats | None,
    facing: float | None,
    *,
    has_gravity: bool,
) -> Alignment:
    """Find the rotation of a sensor whose units are known, and how much it is like the model."""
    scaled = sensed.copy()
    scaled[:, :3] *= scale[0]
    scaled[:, 3:6] *= scale[1]

    def turned(upright: Floats) -> Floats:
        if facing is None:
            return _azimuth(scaled, model, upright, measures) @ upright
        # The way of its z axis, or of its y axis where that is upright.
        axis = upright[:, 2] if abs(upright[2, 2]) < _UPRIGHT else upright[:, 1]
        return about_up(facing - math.atan2(axis[1], axis[0])) @ upright

    turns = [np.eye(3)]
    if measures[2] and reference is not None:
        level = matrix_of(reference)
        turns = [turned(level), turned(_UPSIDE_DOWN @ level)]
    elif measures[0] and has_gravity:
        felt = model[:, :3].mean(axis=0) + np.array([0.0, 0.0, GRAVITY])
        turns = [turned(turn_onto(scaled[:, :3].mean(axis=0), felt))]
    elif measures[:2].any():
        turns = [_whole_turn(scaled, model, measures[:2])]
    found = [Alignment(turn, scale, has_gravity, 0.0, np.zeros(3)) for turn in turns]
    alike = [_likeness(each.motion(sensed), model, measures)[0] for each in found]
    best = np.argmax(alike)
    return replace(found[best], likeness=alike[best])


def averaged(rows: Floats, window: int) -> Floats:
    """Average rows (n, k) over a number of them, (n - window + 1, k)."""
    if window <= 1:
        return rows.copy()
    sums = np.cumsum(np.vstack([np.zeros(rows.shape[1]), rows]), axis=0)
    return (sums[window:] - sums[:-window]) / window


def _gravity_of(acceleration: Floats, notes: list[str]) -> tuple[float, bool, str]:
    """Factor to [m/s^2], whether gravity is in it, and what is wrong."""
    steady = np.linalg.norm(acceleration.mean(axis=0))
    low, high = _GRAVITY_RANGE
    if low < steady / GRAVITY < high:
        return 1.0, True, ''
    if low < steady < high:
        notes.append('acceleration in g')
        return GRAVITY, True, ''
    if steady < _NO_GRAVITY:
        notes.append(_WITHOUT)
        return 1.0, False, ''
    problem = (
        f'a mean acceleration of {steady:.3g} is neither gravity in m/s^2 nor in g, nor without '
        'it: check the unit, and that the sensor was fixed all the time'
    )
    return 1.0, True, problem


def _rate_unit(rate: Floats, model: Floats, notes: list[str]) -> float:
    """Factor to [rad/s]: rates in degrees are 57 times those of the model."""
    own, wanted = (float(np.linalg.norm(each - each.mean(axis=0))) for each in (rate, model))
    if own > max(wanted, 1e-12) * math.sqrt(1.0 / _PER_DEGREE):  # halfway between both units
        notes.append('angular rate in degrees per second')
        return _PER_DEGREE
    return 1.0


def _pairs(
    moved: Floats, model: Floats, measures: Flags
) -> Iterator[tuple[Floats, Floats, float]]:
    """Yield each quantity (n, 3) about its mean, that of the model, and the size of this one."""
    for first in (3 * np.flatnonzero(measures)).tolist():
        own, wanted = (each[:, first : first + 3] for each in (moved, model))
        own, wanted = own - own.mean(axis=0), wanted - wanted.mean(axis=0)
        yield own, wanted, max(np.square(wanted).sum(), 1e-300)


def _azimuth(sensed: Floats, model: Floats, turn: Floats, measures: Flags) -> Floats:
    """Rotation about the vertical that makes upright motion resemble the model's, (3, 3)."""
    across = along = 0.0
    upright = (sensed.reshape(-1, 3) @ turn.T).reshape(sensed.shape)
    for own, wanted, size in _pairs(upright, model, measures):
        along += float((own[:, :2] * wanted[:, :2]).sum()) / size
        turned = own[:, 0] * wanted[:, 1] - own[:, 1] * wanted[:, 0]
        across += float(turned.sum()) / size
    return about_up(math.atan2(across, along))


def _whole_turn(sensed: Floats, model: Floats, measures: Flags) -> Floats:
    """Rotation that makes motion resemble the model's, without gravity, (3, 3)."""
    products = sum(wanted.T @ own / size for own, wanted, size in _pairs(sensed, model, measures))
    left, _, right = np.linalg.svd(products)
    right[2] *= np.linalg.det(left) * np.linalg.det(right)
    return left @ right


def _likeness(moved: Floats, model: Floats, measures: Flags) -> tuple[float, float]:
    """Correlation with the model, and the size of the motion over the model's."""
    product = square = 0.0
    for own, wanted, size in _pairs(moved, model, measures):
        product += float((own * wanted).sum()) / size
        square += float(np.square(own).sum()) / size
    count = measures.sum()
    return product / max(math.sqrt(square * count), 1e-300), math.sqrt(square / max(count, 1.0))


def noise_of(moved: Floats) -> Floats:
    """
    Estimate the deviation of the noise of each quantity, (3,), from the motion of samples, (n, 9).

    The third difference of white noise has 20 times its variance, and hardly any sway. Its median
    counts: a knock, or a gap between two samples, would be most of its mean. Samples that are
    joined by lines have less noise from step to step, and as much in slow sway.
    """
    found = np.zeros(3)
    for quantity in range(3):
        rows = moved[:, 3 * quantity : 3 * quantity + 3]
        if np.isfinite(rows).all() and len(rows) > 3:
            squares = np.square(np.diff(rows, 3, axis=0))
            variance = np.median(squares, axis=0) / _MEDIAN_OF_SQUARE
            found[quantity] = math.sqrt(variance.mean() / 20.0)
    return found


def turn_onto(start: Floats, end: Floats) -> Floats:
    """Smallest rotation of a direction (3,) onto another, as a matrix (3, 3)."""
    a, b = (each / max(float(np.linalg.norm(each)), 1e-300) for each in (start, end))
    cosine = float(a @ b)
    if cosine < -1.0 + 1e-9:
        aside = np.cross(a, np.eye(3)[np.argmin(np.abs(a))])
        aside /= np.linalg.norm(aside)
        return 2.0 * np.outer(aside, aside) - np.eye(3)
    skew = cross_matrix(np.cross(a, b))
    return np.eye(3) + skew + skew @ skew / (1.0 + cosine)


def matrix_of(quaternion: Floats) -> Floats:
    """Rotation matrix (3, 3) of a unit quaternion x y z w."""
    return quaternion_rotated(quaternion[None, [3, 0, 1, 2]], np.eye(3)).T
