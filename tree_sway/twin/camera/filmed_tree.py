# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A tree that sways as a camera sees the real one sway.

Points of a picture are matched to the tree as it stands then. What is followed from there on is
how each moves, so that an error of the match or of the camera is not taken for motion.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats
from tree_sway.core.run import Outcome
from tree_sway.core.tree import ends_of_poses
from tree_sway.twin.camera.limb_points import LimbPoints, matched_points, points_behind
from tree_sway.twin.camera.motion_filter import MotionFilter, TICK
from tree_sway.twin.camera.pinhole import Camera
from tree_sway.twin.disturbance import crown_slope, disturbance
from tree_sway.twin.observed_tree import ObservedTree
from tree_sway.twin.steady_filter import stationary_covariance, sway_law, SwayLaw

_MOST_COORDINATES = 40
"""Largest number of coordinates that a camera corrects."""

_KEPT = 1.0
"""Time in [s] by which a picture may be late."""

_USUAL_WIND = 6.0
"""Mean wind in [m/s] that is taken where none is measured."""

_OWN = 0.3
"""
Variance of an unknown force of each coordinate alone, over that of all gusts, told or not [-].

Gusts of a few limbs push few ways; real wood differs from the model's in every coordinate.
"""

_SLOWEST, _OTHER_WIND = 2.0, 1.6
"""Least mean wind in [m/s] for which a law is found, and the ratio that asks for another one."""

_LAW_EVERY = 300
"""Steps after which the mean wind is looked at."""

_UNTOLD, _UNTOLD_BY_WIND = 0.7, 0.3
"""
Standard deviation of the unknown wind of the whole crown over the mean wind, without an anemometer
and with one [-].
"""

_LASTS = 0.5
"""
Time in [s] after which an unknown force has decayed to 1/e.

That of a wood which is softer than the model's changes as fast as the tree sways.
"""

_CALM = 8.0 * np.pi
"""Angular frequency in [rad/s] of the spring by which the tree follows the estimate."""
_MOST_TURNED = 1.5
"""Largest angle in [rad] by which it turns in a step: half of the way is gone in a longer one."""

_FADE = 0.5
"""Time constant in [s] with which the correction fades without pictures."""

_LOST = 0.5
"""Time in [s] without a picture from which the correction fades."""

_USED = 0.25
"""Weight above which a point is in use."""

_FEWEST = 6
"""Least number of points that a picture must tell."""

_LEAST_MOTION = 1.0
"""Motion in the picture below which noise tells more than the tree [px]."""

_SHAKEN = 0.3
"""Motion in [px] of all that is still from which the camera shakes."""
_STILL, _FEWEST_STILL = 0.02, 3
"""
Motion of points at the foot of the stem over that of the fastest one, below which they are still
where too few are behind the tree, and the least number of them that tell a shake.
"""
_SHAKEN_IN, _LOOKED = 45, 15
"""Pictures in which it is looked for, and after which it is looked for again."""
_REMEMBERED = 0.99
"""Share of the strongest shake that is left then."""

_FEW = 6.0
"""Pictures in a period of the first sway below which they are few."""


class FilmedMotion(NamedTuple):
    """A camera, and of each picture what `FilmedTree.film` takes."""

    camera: Camera
    pictures: Sequence[tuple[float, int, Floats]]

    @property
    def seconds(self) -> float:
        """Time of the last picture in [s]."""
        return self.pictures[-1][0] if self.pictures else 0.0


class FilmedTree(ObservedTree):
    """
    A tree that a camera films.

    Parameters
    ----------
    *arguments, **options
        Those of `ObservedTree`; ``at`` may be empty, or name motion sensors.
    camera
        The camera; None where its first picture will tell where it stands.

    """

    def __init__(
        self, *arguments: Any, camera: Camera | None = None, at: Any = None, **options: Any
    ) -> None:
        super().__init__(*arguments, at=at or {}, **options)
        self.camera = camera
        """The camera; pictures are refused while it is None."""
        self._speed, self._has_wind = _USUAL_WIND, False
        self._is_outdated, self._steps = False, 0
        n = self._n = min(_MOST_COORDINATES, self.banks[0].oscillators.shapes.shape[1])
        self._filmed = np.zeros((2, n))
        self._past: deque[tuple[float, Floats]] = deque()
        self._waiting: deque[tuple[float, int, Floats]] = deque()
        self.points = LimbPoints(*np.zeros((3, 0)))
        """Points that are followed."""
        self._slopes, self._offset = np.zeros((0, 2, n)), np.zeros((0, 2))
        self._poses = np.zeros((self.tree.n_segments, 7))
        self._seen_at = -np.inf
        self._begun_at = self._behind_at = np.zeros((0, 2))
        self._behind = np.zeros(0, dtype=np.int64)
        self.shake = 0.0
        """Strongest shake of the camera in the last minute, root mean square [px]."""
        self.refused = 0
        """Pictures that were too old, out of order, or told too little."""
        self.filter: MotionFilter
        """What the camera tells."""
        self._forget()

    def _law(self) -> SwayLaw:
        """Return the law of what the model lacks, in the present mean wind."""
        n = self._n
        found = disturbance(self, self._speed, n)
        whole = self._speed * crown_slope(self, self._speed, n)[:2]
        together = whole.T @ whole
        untold = _UNTOLD_BY_WIND if self._has_wind else _UNTOLD
        all_gusts = np.diag(found.covariance + np.square(_UNTOLD) * together)
        covariance = found.covariance + np.square(untold) * together + _OWN * np.diag(all_gusts)
        unknown = self.observer.unknown
        damping = unknown.all_damping[:n] + found.air_damping
        return sway_law(unknown.all_stiffness[:n], damping, covariance, _LASTS, TICK)

    def film(self, time: float, reference: int, image: ArrayLike) -> None:
        """
        Offer the points of a picture.

        Parameters
        ----------
        time
            Time of the picture in [s] on the clock of the steps.
        reference
            Number of the picture in which these points were found; points of another one are
            other points.
        image
            Their places in pixels, (k, 2); not a number where one is lost.

        """
        self._waiting.append((time, reference, np.array(image, dtype=np.float64)))

    def step(self, wind_mean: ArrayLike, dt: float) -> int:
        """Advance one step as `ObservedTree.step`, then follow the pictures."""
        eta, rate, _ = self._swing
        n = self._n
        eta[:n] -= self._filmed[0]
        rate[:n] -= self._filmed[1]
        sensed = self._added[:, :n]
        whole = self._filmed + sensed
        status = super().step(wind_mean, dt)
        if status & Outcome.RESTARTED:
            self._forget()
        self._steps += 1
        if self._steps % _LAW_EVERY == 0:
            self._follow_wind()
        self._past.append((self.now, eta - self._added[0]))
        while self._past[0][0] < self.now - _KEPT:
            self._past.popleft()
        # A picture of the end of this step is not to wait for the next one by its rounding.
        while self._waiting and self._waiting[0][0] <= self.now + 0.5 * TICK:
            self._look(*self._waiting.popleft())
        if self.sees:
            ticks = max(round((self.now - self._filter_time) / TICK), 0)
            ahead = self.filter.moved(self.filter.state, ticks)
            # What it tells takes the place of what sensors on the tree tell.
            self._filmed[:] = self._calm(whole, dt, ahead) - sensed
        else:
            self._filmed *= np.exp(-dt / _FADE)
        eta[:n] += self._filmed[0]
        rate[:n] += self._filmed[1]
        return status

    def _calm(self, correction: Floats, dt: float, estimate: Floats) -> Floats:
        """
        Move a correction on by its law, and nearer to the estimate.

        As a spring with critical damping does, the distance to the estimate changes the rate, and
        this rate the place: the noise of a picture makes the tree speed up, not jump. Fast
        coordinates go less far by it, as in an implicit step, or they would grow.
        """
        state = np.stack([*correction, self.filter.state[2]])
        moved = self.filter.moved(state, round(dt / TICK))
        place, rate = estimate - moved
        turned = min(_CALM * dt, _MOST_TURNED)
        left = np.exp(-turned)
        faster = turned * turned / dt * left * place + (1.0 - left * left) * rate
        nearer = (
            dt * faster / (1.0 + np.square(dt) * self.observer.unknown.all_stiffness[: self._n])
        )
        return moved + np.stack([nearer, faster])

    def _memory(self) -> tuple[Floats, ...]:
        """Return views of the state, with the correction in it."""
        return (*super()._memory(), self._filmed)

    def _glide(self, dt: float) -> bool:
        """Continue a transition of `tune`, and expect the motion of the changed tree."""
        is_changed = super()._glide(dt)
        self._is_outdated |= is_changed
        return is_changed

    def _follow_wind(self) -> None:
        """Take the law of the present mean wind and of the present tree."""
        measured = self.observer.mean_wind
        has_wind = measured > 0.0
        speed = max(measured, _SLOWEST) if has_wind else _USUAL_WIND
        self._is_outdated |= has_wind != self._has_wind
        self._has_wind = has_wind
        if self._is_outdated or not 1.0 / _OTHER_WIND < speed / self._speed < _OTHER_WIND:
            self._speed, self._is_outdated = speed, False
            self.filter.set_law(self._law())

    def _look(self, time: float, reference: int, image: Floats) -> None:
        """Follow the points of a picture."""
        if self.camera is None or time < self._past[0][0] - 0.1 or time <= self._seen_at:
            self.refused += 1
            return
        if not np.isfinite(self._seen_at) or time - self._seen_at > 5.0:
            self._filter_time = time
        ticks = max(round((time - self._filter_time) / TICK), 0)
        self._filter_time += ticks * TICK
        self.filter.advance(ticks)
        eta = self._computed(time)
        eta[: self._n] += self.filter.state[0]
        shapes = self.banks[0].oscillators.shapes
        poses = self.place_rotations(np.ascontiguousarray(shapes @ eta), self._poses)
        if reference != self._reference:
            self._begin(self.camera, reference, poses, image)
        expected = self.camera.project(self.points.at(poses)) + self._offset
        seen = image[self.points.row]
        missed = seen - expected
        if np.isfinite(missed).all(axis=1).sum() < _FEWEST:
            self.refused += 1
            return
        self._picture_rate += 0.1 * (1.0 / (time - self._seen_at) - self._picture_rate)
        self._seen_at = time
        self._note_behind(image[self._behind] - self._behind_at)
        moved = np.square(seen - self._begun_at).sum(axis=1)
        self._square += np.nanmedian(moved)
        self._n_seen += 1
        self.filter.see(self._slopes, np.einsum('pij,pj->pi', self._axes, missed))

    def _note_behind(self, moved: Floats) -> None:
        """Note how far points that should be still are from where they were found, (k, 2)."""
        moved = moved[np.isfinite(moved).all(axis=1)]
        if len(moved) < _FEWEST_STILL:
            return
        shift = np.median(moved, axis=0)
        self._shifts.append((*shift, np.median(np.abs(moved - shift))))
        n = len(self._shifts)
        if n == _SHAKEN_IN and self._n_seen % _LOOKED == 0:
            rows, at = np.array(self._shifts), np.linspace(-1.0, 1.0, n)
            # A cloud drifts evenly.
            left = rows - rows.mean(axis=0) - np.outer(at, at @ rows) / (at @ at)
            found = np.sqrt(np.square(left[:, :2]).sum(axis=1).mean())
            self.shake *= _REMEMBERED
            if found > 2.0 * np.median(rows[:, 2]):
                self.shake = max(self.shake, found)

    def _begin(self, camera: Camera, reference: int, poses: Floats, image: Floats) -> None:
        """Follow the points of another picture, in which the tree has these poses."""
        self._reference = reference
        self._n_begun += 1
        self._shifts.clear()
        found = matched_points(self.tree, poses, camera, image)
        self.points = found
        at = found.at(poses)
        self._begun_at = image[found.row]
        self._offset = self._begun_at - camera.project(at)
        seen = camera.slopes(at)
        start, end = ends_of_poses(poses[found.segment], self.tree.length[found.segment])
        along = np.einsum('pij,pj->pi', seen, end - start)
        along /= np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-9)
        self._axes = np.stack([along, along[:, ::-1] * [-1.0, 1.0]], axis=1)
        self._slopes = self._axes @ seen @ found.slopes(self)[:, :, : self._n]
        gusts = self._usual_covariance[: self._n, : self._n]
        # In usual gusts, root mean square [px].
        moves = np.sqrt(np.einsum('pij,jk,pik->p', self._slopes, gusts, self._slopes))
        still = found.row[moves < _STILL * moves.max(initial=0.0)]
        behind = points_behind(self.tree, poses, camera, image)
        self._behind = behind if len(behind) >= _FEWEST else still
        self._behind_at = image[self._behind]
        self.filter.begin(len(found.row))

    def _computed(self, time: float) -> Floats:
        """Coordinates of the model at a time in [s], without the camera's correction, (m,)."""
        later = before = self._past[-1]
        for each in reversed(self._past):
            later, before = before, each
            if each[0] <= time:
                break
        share = (time - before[0]) / max(later[0] - before[0], 1e-9)
        return before[1] + np.clip(share, 0.0, 1.0) * (later[1] - before[1])

    def _forget(self) -> None:
        """Begin anew from rest."""
        self._filmed[:] = 0.0
        self._past.clear()
        self._waiting.clear()
        self._square, self._n_seen = 0.0, 0
        self._seen_at, self._reference = -np.inf, -1
        self._n_begun, self._picture_rate = 0, 0.0
        self._shifts = deque[tuple[float, float, float]](maxlen=_SHAKEN_IN)
        self.shake = 0.0
        law = self._law()
        self._usual_covariance = stationary_covariance(law)
        self.filter = MotionFilter(law, self._usual_covariance)

    @property
    def sees(self) -> bool:
        """Whether a picture of the last moments corrects it."""
        return self.now - self._seen_at < _LOST

    @property
    def motion(self) -> float:
        """How far the points moved in the picture, root mean square [px]; 0 before any."""
        return float(np.sqrt(self._square / max(self._n_seen, 1)))

    @property
    def error(self) -> float:
        """Median of the errors of the points [px]; 0 before any."""
        errors = self.filter.errors
        return float(np.median(errors)) if len(errors) else 0.0

    @property
    def said(self) -> str:
        """What the camera tells, or why it tells nothing, one sentence."""
        n_points = len(self.points.row)
        if not np.isfinite(self._seen_at):
            why = 'no picture of the time of the wind'
            if n_points or self.refused:
                why = (
                    f'{n_points} points on the tree are too few: check the clicks, the light and '
                    'whether the picture is sharp'
                )
            return f'the camera moves nothing: {why}'
        used = int((self.filter.weights > _USED).any(axis=1).sum())
        told = (
            f'the camera: {n_points} points on the tree, {used} in use at the end, their error '
            f'{self.error:.1f} px; {self.refused} pictures refused'
        )
        if not self.sees:
            told += f'; no picture in the last {self.now - self._seen_at:.1f} s'
        if used < 0.25 * n_points:
            told += '; most points are lost: was the camera moved, or did the light change?'
        if self._n_begun > 1:
            told += '; points were found anew: check that the camera stands where it stood'
        if self.shake > _SHAKEN:
            told += (
                f'; what is still moves by {self.shake:.1f} px: the camera shakes, and '
                'that is taken for sway: use a tripod'
            )
        if self._picture_rate < _FEW * self.frequencies(1)[0]:
            told += (
                f'; {self._picture_rate:.0f} pictures a second are few: its sway is told roughly'
            )
        if self.motion < _LEAST_MOTION:
            told += (
                f'; they moved by {self.motion:.1f} px, and less than a pixel tells little: film '
                'nearer, with more pixels, or in more wind'
            )
        return told

    def reset(self) -> None:
        """Return to rest, with no wind; the points are matched anew."""
        super().reset()
        self._forget()
