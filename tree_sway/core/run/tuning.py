# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Stiffness, damping and weight of a tree changed while it sways, without building it again.

A change takes the time `GLIDE`, so that no pose jumps. Modes keep their shapes: a mode of elastic
stiffness k_e and of weight k_g per unit of gravity has ``w^2 = s k_e + g k_g``, Rayleigh's
quotient, whose error is of the order of the squared change of the shapes.
"""

from __future__ import annotations

from dataclasses import astuple, dataclass, replace
import math

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.checks import within
from tree_sway.core.run.bank import Tunable
from tree_sway.core.settings import Settings
from tree_sway.errors import ParameterError

GLIDE = 0.5
"""Duration of a change in [s]."""

_RANGES = {
    'damping_ratio': (0.0, 1.0, ''),
    'stiffness_factor': (0.1, 10.0, ''),
    'gravity': (0.0, 30.0, 'm/s^2'),
}


@dataclass(frozen=True)
class Tuning:
    """
    Values that may change while a tree sways.

    Parameters
    ----------
    damping_ratio
        Damping ratio of every oscillator in [-], 0 to 1.
    stiffness_factor
        Factor on the elastic stiffness of the tree as it was made in [-], 0.1 to 10.
    gravity
        Gravity in [m/s^2], 0 to 30.

    """

    damping_ratio: float
    stiffness_factor: float
    gravity: float


class LiveTuning:
    """Transition of the oscillators of a model from one tuning to the next."""

    def __init__(self, tunable: Tunable, settings: Settings, damping_ratio: float) -> None:
        """Split the stiffness into that of the wood and that of the weight."""
        self._tunable = tunable
        gravity = settings.gravity
        self._has_volume_rule = settings.volume_stiffness > 0.0
        self._made = self._now = self.goal = Tuning(damping_ratio, 1.0, gravity)
        self._left = 0.0
        weight = tunable.weight
        self._per_gravity = weight / gravity if gravity > 0.0 else 0.0 * weight
        self._elastic = tunable.stiffness - weight
        self._others = [array.copy() for array, _ in tunable.others]

    @property
    def changes(self) -> tuple[Tuning, ...]:
        """Return the target tuning, or None where it is that of the start."""
        return () if self.goal == self._made else (self.goal,)

    @property
    def is_moving(self) -> bool:
        """Return whether the next step changes the coefficients."""
        return self._left > 0.0

    def changed(self, **changes: float) -> Tuning:
        """
        Return the goal with some values changed.

        A `ParameterError` names a value that may not change, that is out of its range, by which
        the tree buckles, weight on a tree that was made without, or any change of the volume rule.
        """
        for name, value in changes.items():
            if name not in _RANGES:
                raise ParameterError(
                    f"'{name}' cannot change while the tree sways",
                    where='tune',
                    cure=f'use one of: {", ".join(_RANGES)}; or make the simulator again',
                )
            within(name, value, *_RANGES[name])
        goal = replace(self.goal, **changes)
        if self._has_volume_rule and goal != self._made:
            raise ParameterError(
                f'another {next(iter(changes))} with the volume rule',
                where='tune',
                cure='make the simulator again with other constants of the rule',
            )
        if goal.gravity > 0.0 and not self._made.gravity > 0.0:
            raise ParameterError(
                f'gravity {goal.gravity:g} m/s^2 on a tree made without weight',
                where='gravity',
                cure='make the tree with its gravity, then change it',
            )
        if not (self._stiffness(goal) > 0.0).all():
            raise ParameterError(
                f'a tree that buckles at {goal.stiffness_factor:g} of its stiffness under '
                f'{goal.gravity:g} m/s^2',
                where='stiffness_factor',
                cure='give more stiffness, or less gravity',
            )
        return goal

    def go_to(self, goal: Tuning, within: float = GLIDE) -> None:
        """Start the transition to a checked tuning, of a time in [s], with the next step."""
        self.goal = goal
        self._left = within

    def step(self, dt: float) -> bool:
        """Continue the transition by a step [s]; return whether the coefficients have changed."""
        if self._left <= 0.0:
            return False
        share = min(dt / self._left, 1.0)
        self._left -= dt
        pairs = zip(astuple(self._now), astuple(self.goal), strict=True)
        mix = Tuning(*(now + share * (goal - now) for now, goal in pairs))
        self._now = self.goal if share == 1.0 else mix
        self._apply(self._now)
        return True

    def _stiffness(self, tuning: Tuning) -> Floats:
        """Stiffness of each oscillator."""
        weight = tuning.gravity * self._per_gravity
        return np.asarray(tuning.stiffness_factor * self._elastic + weight)

    def _apply(self, tuning: Tuning) -> None:
        stiffness = self._stiffness(tuning)
        tunable = self._tunable
        tunable.stiffness[:] = stiffness
        ratio = tuning.damping_ratio * tunable.loss + tunable.unknown
        tunable.damping[:] = ratio * tunable.critical
        for (array, power), made in zip(tunable.others, self._others, strict=True):
            array[:] = made * math.pow(tuning.stiffness_factor, power)
