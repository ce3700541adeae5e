# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""How a tree is modelled: every setting of a simulator, in one place."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
import math
from typing import Any

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.checks import one_of, refuse_other_kind, whole, within
from tree_sway.core.wind import FASTEST_WIND, WindProfile
from tree_sway.errors import nearest, ParameterError

GUSTS = ('expected', 'sample', 'measured')
"""Winds of a tree apart from its anemometer: least error, one that may be, or as measured."""

USUAL = 60
"""Default number of coordinates."""

OF_LAB = ('full',)
"""Models of the laboratory, which is a project of its own."""

MODELS = ('auto', 'branch', *OF_LAB)
"""Models with a name; others are numbers of coordinates, or come from further packages."""

MOST = 1000
"""Largest number of coordinates."""
_MOST_DIGITS = 9

STIFFEST = 1e7
"""Largest stiffness in [N/m] of a spring at a segment."""

_ENRICHED = ('none', 'stem', 'needed', 'carriers', 'all')
"""Choices of branches with further shapes."""

MOST_SEED = 2**31 - 1
"""Largest seed of a sample of gusts."""

_RANGES = {
    'volume_stiffness': (0.0, 1e9, 'N m/rad/m^3', False),
    'volume_damping': (0.0, 1e9, 'N m s/rad/m^3', True),
    'damping_ratio': (0.0, 1e3, '', False),
    'gravity': (0.0, 1e3, 'm/s^2', False),
    'crown_coherence': (0.0, 1.0, '', False),
    'anemometer_distance': (0.0, 1000.0, 'm', False),
    'anemometer_bearing': (-6.3, 6.3, 'rad', False),
    'root_stiffness': (0.0, math.inf, 'N m/rad', True),
    'max_wind': (0.0, FASTEST_WIND, 'm/s', True),
}
"""Smallest and largest value, unit, and whether the smallest itself is refused."""


@dataclass(frozen=True, eq=False)
class Settings:
    """
    How a tree is modelled; its material is that of its species.

    Parameters
    ----------
    model
        Number of coordinates of the tree, or all if there are fewer; 0 does not move. Or
        ``branch``, the paper's, isolated branches; ``auto``, the smallest number that suffices for
        the scene; or ``full``, all coordinates and the load of every branch, where the laboratory
        is installed.
    volume_stiffness, volume_damping
        The two constants of the paper's rule for the model ``branch``, stiffness and damping of a
        branch over its volume in [N m/rad/m^3] and [N m s/rad/m^3]; a stiffness of 0 for that of
        its beam.
    damping_ratio
        Damping ratio of every oscillator in [-]; that of the species if None.
    in_leaf
        Whether the tree bears leaves; if None, evergreen species do.
    gravity
        Gravity in [m/s^2]; 0 leaves weight out.
    profile
        Profile of the wind over height.
    crown_coherence
        Share of a gust in [-] that reaches the whole crown at once; the rest reaches each limb
        after its own delay (`crown_wind`). 1 is one wind for the whole crown.
    anemometer_distance
        Distance in [m] from the tree to the anemometer, which is as high as the tree: the farther,
        the less of a gust is the same (`far_wind`). 0 for one wind at both. It takes the place of
        `crown_coherence`.
    anemometer_bearing
        Where the anemometer stands from the tree, clockwise from north in [rad]; None if unknown.
    gusts
        Wind of a tree apart from its anemometer: the one ``expected``, which has the least error
        and is smooth; a ``sample``, one that may be, as rough as the real one; or ``measured``.
    gust_seed
        Seed of a sample: two sites with the same one see the same gusts.
    enrich
        Branches with further shapes and twists, on all models but ``branch``: ``none``, the
        ``stem``, those ``needed`` (`TreeBeams.enriched`), all ``carriers`` of others, or ``all``.
    root_stiffness
        Stiffness of the roots against tilting in [N m/rad], infinite if they are rigid; the tree's
        own if None.
    leaf_mass, leaf_area
        Leaves of each branch in [kg] and [m^2], (b,); those of the species in leaf if both are
        None.
    max_wind
        Wind speed in [m/s] above which a sample is refused.

    """

    model: int | str = USUAL
    volume_stiffness: float = 0.0
    volume_damping: float = 2.0e3
    damping_ratio: float | None = None
    in_leaf: bool | None = None
    gravity: float = 9.81
    profile: WindProfile = field(default_factory=WindProfile)
    crown_coherence: float = 1.0
    anemometer_distance: float = 0.0
    anemometer_bearing: float | None = None
    gusts: str = 'expected'
    gust_seed: int = 0
    enrich: str = 'needed'
    root_stiffness: float | None = None
    leaf_mass: Floats | None = None
    leaf_area: Floats | None = None
    max_wind: float = FASTEST_WIND

    def __post_init__(self) -> None:
        """Raise a `ParameterError` for a value out of its range, or of a wrong type."""
        object.__setattr__(self, 'model', model_of(self.model))
        known = self.__dataclass_fields__
        for name, (low, high, unit, above) in _RANGES.items():
            value = getattr(self, name)
            if value is not None or known[name].default is not None:
                number = within(name, value, low, high, unit, above=above)
                object.__setattr__(self, name, number)
        object.__setattr__(self, 'gust_seed', whole('gust_seed', self.gust_seed, 0, MOST_SEED))
        one_of('enrich', self.enrich, _ENRICHED)
        one_of('gusts', self.gusts, GUSTS)
        one_of('in_leaf', self.in_leaf, (True, False, None))
        refuse_other_kind('profile', self.profile, WindProfile, 'give WindProfile(...)')
        if self.volume_stiffness and self.model != 'branch':
            raise ParameterError(
                f"the volume rule on model '{self.model}'",
                where='volume_stiffness',
                cure="use it on model 'branch', or 0 for the stiffness of beams",
            )
        if self.in_leaf is False and (self.leaf_mass is not None or self.leaf_area is not None):
            raise ParameterError(
                'leaves on a bare tree', where='in_leaf', cure='leave in_leaf out, or the leaves'
            )

    @property
    def is_far(self) -> bool:
        """Whether the tree stands apart from its anemometer (`far_wind`)."""
        return self.anemometer_distance > 0.0 and self.gusts != 'measured'

    @property
    def wind_told(self) -> str:
        """By which gusts the tree sways, and where its anemometer is taken to stand."""
        if self.anemometer_distance <= 0.0:
            return 'as measured; the anemometer is taken to stand at the tree (its distance is 0)'
        where = f'anemometer {self.anemometer_distance:g} m away'
        if self.anemometer_bearing is not None:
            where += f' at {math.degrees(self.anemometer_bearing) % 360.0:.0f} degrees'
        kinds = 'the expected wind', f'a sample, seed {self.gust_seed}', 'as measured'
        return f'{kinds[GUSTS.index(self.gusts)]}; {where}'

    @property
    def has_limb_winds(self) -> bool:
        """Whether parts of the crown have winds of their own."""
        return self.crown_coherence < 1.0 or self.is_far

    def __repr__(self) -> str:
        """Return the model and the fields that are not the default on one line."""
        shown = []
        for each in fields(self):
            value = getattr(self, each.name)
            default = WindProfile() if each.name == 'profile' else each.default
            if isinstance(value, np.ndarray):
                shown.append(f'{each.name}=<{value.size} numbers>')
            elif each.name == 'model' or value != default:
                shown.append(f'{each.name}={value!r:.80}')
        return f'Settings({", ".join(shown)})'

    def __eq__(self, other: object) -> bool:
        """Compare every field, arrays by their numbers."""
        return isinstance(other, Settings) and self._digest() == other._digest()

    def __hash__(self) -> int:
        """Hash the fields that `__eq__` compares."""
        return hash(self._digest())

    def _digest(self) -> str:
        from tree_sway.core.tree_state import digest_of

        return digest_of(self)


def settings_with(settings: Settings | None, changes: Mapping[str, Any]) -> Settings:
    """
    Return settings, the defaults if None, with some fields changed.

    A `ParameterError` names an object that is not settings, an unknown field, or a value out of
    its range.
    """
    if not isinstance(settings, Settings | None):
        raise ParameterError(
            f'a {type(settings).__name__}, where Settings are expected',
            where='settings',
            cure='give Settings(...), or its fields as keywords',
        )
    known = Settings.__dataclass_fields__
    for name in changes:
        if name not in known:
            cure = nearest(name, known) or f'there are: {", ".join(known)}'
            raise ParameterError(f"unknown setting '{name}'", cure=cure)
    return replace(settings or Settings(), **changes)


def model_of(given: object) -> int | str:
    """
    Return a model as a field of `Settings`: a number, also from text, or the name of a model.

    A `ParameterError` lists the models; a `MissingDependencyError` says what to install for one.
    """
    if isinstance(given, str) and given in MODELS:
        if given in OF_LAB:
            from tree_sway.installed_models import refuse_missing_model

            refuse_missing_model(given)
        return given
    number = given
    if isinstance(given, str) and given.isdecimal() and len(given) <= _MOST_DIGITS:
        number = int(given)
    if isinstance(number, float) and number.is_integer():
        number = int(number)  # files of numbers have floats
    if isinstance(number, int) and not isinstance(number, bool) and 0 <= number <= MOST:
        return number
    from tree_sway.installed_models import installed_models

    models = dict.fromkeys((*MODELS, *installed_models()))
    if isinstance(given, str) and given in models:
        return given
    near = nearest(str(given), models)
    raise ParameterError(
        f"unknown model '{given}'",
        where='model',
        cure=f'{near + ", or " if near else ""}use one of: {", ".join(models)}, or a number of '
        f'coordinates from 0 to {MOST}',
    )
