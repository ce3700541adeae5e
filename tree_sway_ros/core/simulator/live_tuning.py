# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Stiffness, damping and weight of a tree changed while it sways, without building it anew.

A change is gone over in `GLIDE`, so that no pose jumps. Modes keep their shapes: a mode of elastic
stiffness k_e and of weight k_g per unit of gravity has ``w^2 = s k_e + g k_g``, Rayleigh's
quotient, which errs by the square of what the shapes would change by.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields, replace
import math

import numpy as np

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.core.checks import within
from tree_sway_ros.core.motion.modal import ModalBank
from tree_sway_ros.core.motion.uncoupled import UncoupledBank
from tree_sway_ros.core.oscillators.rule_names import CONDITIONALLY_STABLE
from tree_sway_ros.core.reduction.matrices import Reduction
from tree_sway_ros.core.simulator.settings import Settings
from tree_sway_ros.errors import ParameterError

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

        A `ParameterError` tells of a name that may not change, or a value out of its range.
        """
        for name, value in changes.items():
            if name not in _RANGES:
                raise ParameterError(
                    f"'{name}' cannot change while the tree sways",
                    where='tune',
                    cure=f'use one of: {", ".join(_RANGES)}; or make the simulator anew',
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
    """
    Takes the oscillators of a model from one tuning to the next.

    ``is_tabled`` tells that their load comes from a table, which holds for one stiffness.
    """

    def __init__(
        self,
        oscillators: ModalBank | UncoupledBank,
        reduction: Callable[[], Reduction],
        settings: Settings,
        damping_ratio: float,
        is_tabled: bool = False,
    ) -> None:
        """Split the stiffness into that of the wood and that of the weight."""
        self._of, self._settings, self._is_tabled = oscillators, settings, is_tabled
        self._made = self._now = self.goal = Tuning.of(settings, damping_ratio)
        self._left = 0.0
        self._stiffness, self._damping = oscillators.stiffness.copy(), oscillators.damping.copy()
        self._rest: list[tuple[Floats, Floats, float]] = []
        if isinstance(oscillators, ModalBank):
            weight = oscillators.weight
            powers = ('flexibility', -1.0), ('held', -1.0), ('limit', 1.0)
            for name, power in powers:
                array = getattr(oscillators, name)
                self._rest.append((array, array.copy(), power))
        else:
            diagonal = np.asarray(reduction().gravity.diagonal())
            weight = diagonal.reshape(-1, 2).mean(axis=1)
        self._per_gravity = weight / settings.gravity if settings.gravity > 0.0 else 0.0 * weight

    def check(self, goal: Tuning) -> None:
        """
        Refuse a tuning that this tree cannot take, with a `ParameterError`.

        That is a tree that would buckle, weight on one that was made without, a value that the
        rule of stiffness or the table in use does not know, or more stiffness than the integrator
        may stand.
        """
        rule = self._settings.stiffness
        unused = _OF_BEAMS if rule == 'volume_rule' else _OF_VOLUMES
        for name in (*unused, *(_OF_BEAMS[1:] if self._is_tabled else ())):
            if getattr(goal, name) != getattr(self._made, name):
                table = " on model 'wind_basis'" if self._is_tabled else ''
                raise ParameterError(
                    f"another {name} with stiffness '{rule}'{table}",
                    where=name,
                    cure='the volume rule takes its two constants, beams take the others, and '
                    "'wind_basis' takes the damping ratio alone",
                )
        if goal.gravity > 0.0 and not self._settings.gravity > 0.0:
            raise ParameterError(
                f'gravity {goal.gravity:g} m/s^2 on a tree made without weight',
                where='gravity',
                cure='make the tree with its gravity, then change it',
            )
        stiffness = self._of_tuning(goal)
        is_stiffer = bool((stiffness > self._stiffness).any())
        if is_stiffer and self._settings.integrator in CONDITIONALLY_STABLE:
            raise ParameterError(
                f"more stiffness under the integrator '{self._settings.integrator}'",
                where='stiffness_factor',
                cure='make the simulator anew, or use an integrator that is always stable',
            )
        if not (stiffness > 0.0).all():
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
        """Go on by a step [s]; tell whether the coefficients have changed."""
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
            inertia = of.inertia if isinstance(of, UncoupledBank) else 1.0
            of.damping[:] = 2.0 * tuning.damping_ratio * np.sqrt(stiffness * inertia)
        of.stiffness[:] = stiffness
        for array, made, power in self._rest:
            array[:] = made * math.pow(tuning.stiffness_factor, power)
