# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Stiffness, damping and weight of a tree changed while it sways, without building it again.

A change is gone over in `GLIDE`, so that no pose jumps. Modes keep their shapes: a mode of elastic
stiffness k_e and of weight k_g per unit of gravity has ``w^2 = s k_e + g k_g``, Rayleigh's
quotient, which errs by the square of what the shapes would change by.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
import math

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.checks import within
from tree_sway.core.motion.branchwise import Tunable
from tree_sway.core.simulator.settings import Settings
from tree_sway.errors import ParameterError

GLIDE = 0.5
"""Time in [s] over which a change is taken on."""


@dataclass(frozen=True)
class Tuning:
    """
    What may change while a tree sways.

    Parameters
    ----------
    damping_ratio
        Of every oscillator in [-], 0 to 1.
    stiffness_factor
        Elastic stiffness over that which the tree was made with in [-], 0.1 to 10.
    gravity
        In [m/s^2], 0 to 30.
    volume_stiffness, volume_damping
        The two constants of the volume rule in [N m/rad/m^3] and [N m s/rad/m^3], above 0 to 1e9.

    """

    damping_ratio: float
    stiffness_factor: float
    gravity: float
    volume_stiffness: float
    volume_damping: float

    @staticmethod
    def of(settings: Settings, damping_ratio: float) -> Tuning:
        """Return what a tree is made with."""
        constants = settings.volume_stiffness, settings.volume_damping
        return Tuning(damping_ratio, 1.0, settings.gravity, *constants)

    def changed(self, **changes: float) -> Tuning:
        """
        Return this with some values changed.

        A `ParameterError` names what may not change, or a value out of its range.
        """
        for name, value in changes.items():
            if name not in _RANGES:
                raise ParameterError(
                    f"'{name}' cannot change while the tree sways",
                    where='tune',
                    cure=f'use one of: {", ".join(_RANGES)}; or make the simulator again',
                )
            low, high, unit, above = _RANGES[name]
            within(name, value, low, high, unit, above=above)
        return replace(self, **changes)

    def towards(self, goal: Tuning, share: float) -> Tuning:
        """Return the mix of this and another."""
        here = {one.name: getattr(self, one.name) for one in fields(self)}
        return Tuning(**{k: v + share * (getattr(goal, k) - v) for k, v in here.items()})


_OF_VOLUMES: tuple[str, ...] = ('volume_stiffness', 'volume_damping')
_OF_BEAMS: tuple[str, ...] = ('damping_ratio', 'stiffness_factor', 'gravity')

_RANGES: dict[str, tuple[float, float, str, bool]] = {
    'damping_ratio': (0.0, 1.0, '', False),
    'stiffness_factor': (0.1, 10.0, '', False),
    'gravity': (0.0, 30.0, 'm/s^2', False),
    'volume_stiffness': (0.0, 1e9, 'N m/rad/m^3', True),
    'volume_damping': (0.0, 1e9, 'N m s/rad/m^3', True),
}


LIVE = tuple(_RANGES)
"""What may change while a tree sways."""


class LiveTuning:
    """Takes the oscillators of a model from one tuning to the next."""

    def __init__(self, tunable: Tunable, settings: Settings, damping_ratio: float) -> None:
        """Split the stiffness into that of the wood and that of the weight."""
        self._of, self._settings = tunable, settings
        self._made = self._now = self.goal = Tuning.of(settings, damping_ratio)
        self._left = 0.0
        self._stiffness, self._damping = tunable.stiffness.copy(), tunable.damping.copy()
        self._others = [array.copy() for array, _ in tunable.others]
        weight, gravity = tunable.weight, settings.gravity
        self._per_gravity = weight / gravity if gravity > 0.0 else 0.0 * weight

    @property
    def changes(self) -> tuple[Tuning, ...]:
        """Return the tuning that is gone to, or nothing where it is that of the start."""
        return () if self.goal == self._made else (self.goal,)

    @property
    def is_moving(self) -> bool:
        """Return whether the next step changes something."""
        return self._left > 0.0

    def check(self, goal: Tuning) -> None:
        """
        Refuse a tuning that this tree cannot take, with a `ParameterError`.

        That is a tree that would buckle, weight on one that was made without, or a value that the
        rule of stiffness in use does not have.
        """
        rule = self._settings.stiffness
        for name in _OF_BEAMS if rule == 'volume_rule' else _OF_VOLUMES:
            if getattr(goal, name) != getattr(self._made, name):
                raise ParameterError(
                    f"another {name} with stiffness '{rule}'",
                    where=name,
                    cure='the volume rule takes its two constants, beams take the others',
                )
        if goal.gravity > 0.0 and not self._settings.gravity > 0.0:
            raise ParameterError(
                f'gravity {goal.gravity:g} m/s^2 on a tree made without weight',
                where='gravity',
                cure='make the tree with its gravity, then change it',
            )
        if not (self._of_tuning(goal) > 0.0).all():
            raise ParameterError(
                f'a tree that buckles at {goal.stiffness_factor:g} of its stiffness under '
                f'{goal.gravity:g} m/s^2',
                where='stiffness_factor',
                cure='give more stiffness, or less gravity',
            )

    def go_to(self, goal: Tuning) -> None:
        """Take on a tuning that was checked, from the next step on."""
        self.goal, self._left = goal, GLIDE

    def step(self, dt: float) -> bool:
        """Go on by a step [s]; return whether the coefficients have changed."""
        if self._left <= 0.0:
            return False
        share = min(dt / self._left, 1.0)
        self._left -= dt
        self._now = self.goal if share == 1.0 else self._now.towards(self.goal, share)
        self._apply(self._now)
        return True

    def _of_tuning(self, tuning: Tuning) -> Floats:
        """Stiffness of each oscillator."""
        made = self._made
        if self._settings.stiffness == 'volume_rule':
            return np.asarray(self._stiffness * (tuning.volume_stiffness / made.volume_stiffness))
        elastic = self._stiffness - made.gravity * self._per_gravity
        return np.asarray(tuning.stiffness_factor * elastic + tuning.gravity * self._per_gravity)

    def _apply(self, tuning: Tuning) -> None:
        stiffness, of = self._of_tuning(tuning), self._of
        if self._settings.stiffness == 'volume_rule':
            of.damping[:] = self._damping * (tuning.volume_damping / self._made.volume_damping)
        else:
            critical = 2.0 * np.sqrt(stiffness * of.inertia)
            of.damping[:] = tuning.damping_ratio * of.loss * critical
        of.stiffness[:] = stiffness
        for (array, power), made in zip(of.others, self._others, strict=True):
            array[:] = made * math.pow(tuning.stiffness_factor, power)
