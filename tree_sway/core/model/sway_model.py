# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The prepared model of a tree: all that set-up finds, as named arrays.

Set-up makes it once; a simulator needs nothing else. It is what the cache stores, what an ``.npz``
file of a tree has, and where the description for receivers and the table for JavaScript come from,
under the same names. ``doc/sway_model.md`` documents every array and the law of a step.

Coordinates are dimensionless and of unit inertia: 1 kg m^2 each.

Sizes: n segments, b branches (a branch that rotates far is cut into several), N key rotations of
all branches, k the largest number of them in one branch, m coordinates, q leading coordinates,
s streamed coordinates, A azimuths and L levels of the table, h harmonics.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields, MISSING, replace
from functools import cached_property
import hashlib
from typing import Any, NamedTuple, TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.arrays import Floats, Ints, Records, Singles
from tree_sway.core.checks import GREATEST
from tree_sway.core.drag import DragLaw
from tree_sway.core.model.records import (
    branches_at_rest,
    LOADED,
    N_AZIMUTHS,
    N_HARMONICS,
    N_LEVELS,
    PLACED,
    ROOMS,
)
from tree_sway.core.settings import Settings
from tree_sway.core.species import Species
from tree_sway.core.tree import Tree
from tree_sway.errors import FormatError

if TYPE_CHECKING:
    from tree_sway.core.model.state_basis import StateBasis

PLACING, LOADS, COORDINATES, STREAM, TABLE, ISOLATED, LIMBS, LIMB_LOADS, LIMP = (
    'placing', 'loads of branches', 'coordinates', 'stream', 'table', 'isolated branches', 'limbs',
    'loads of limbs', 'limp trees',
)  # fmt: skip
"""Groups of arrays."""

_NONE: Any = np.zeros(0)
"""Array that a model does not have."""


class Meaning(NamedTuple):
    """Group, shape, unit and meaning of an array; shapes are of numbers and names of sizes."""

    group: str
    shape: tuple[int | str, ...]
    unit: str
    text: str


def _array(group: str, shape: str, unit: str, text: str, **default: Any) -> Any:
    """Describe an array that every model has; its shape is of numbers and names of sizes."""
    sizes = tuple(int(each) if each.isdigit() else each for each in shape.split(', '))
    return field(metadata={'meaning': Meaning(group, sizes, unit, text)}, **default)


def _optional(group: str, shape: str, unit: str, text: str) -> Any:
    """Describe an array that is empty in models whose law does not need it."""
    return _array(group, shape, unit, text, default_factory=lambda: _NONE)


@dataclass(frozen=True, eq=False)
class SwayModel:
    """
    Prepared model of a tree.

    Arrays of a group that the law does not need are empty. `MEANINGS` has the shape, the unit and
    the meaning of every array.

    Parameters
    ----------
    tree, species, settings
        Inputs of its set-up; the settings include the leaves that the tree bears.
    drag_law
        Drag of the whole tree.
    damping_ratio
        Damping ratio of the wood in [-].
    mass
        Mass of wood and leaves in [kg].
    most_pressure
        Largest dynamic pressure of the table in [kg/m/s^2].
    most_energy
        Twice the largest strain and kinetic energy that wind gives, [J].

    """

    tree: Tree
    species: Species
    settings: Settings
    drag_law: DragLaw
    damping_ratio: float
    mass: float

    branch_first: Ints = _array(
        PLACING, 'b + 1', '',
        'first segment of each branch, and n at the end',
    )  # fmt: skip
    branch_parent: Ints = _array(
        PLACING, 'b', '',
        'parent branch, -1 for the stem; parents come first',
    )  # fmt: skip
    branch_base_segment: Ints = _array(
        PLACING, 'b', '',
        'segment of the parent at its base, -1 for the stem',
    )  # fmt: skip
    branch_coordinate: Ints = _array(PLACING, 'b', '', 'its first key rotation')
    branch_keys: Ints = _array(PLACING, 'b', '', 'number of its key rotations, 2 or more')
    branch_frame: Floats = _array(
        PLACING, 'b, 3, 3', '',
        'chord and the two axes e1, e2 across it at rest, as rows; the first key rotation turns '
        'the chord about e2, the second about -e1',
    )  # fmt: skip
    branch_skew: Floats = _array(
        PLACING, 'b, 2', '',
        'third cumulant over 6 of the slope, and of the slope under a load at the tip',
    )  # fmt: skip
    branch_offset: Floats = _array(
        PLACING, 'b, 3', 'm',
        'base from the start of the base segment, in the frame of that segment; 0 for the stem',
    )  # fmt: skip
    branch_twist: Floats = _array(
        PLACING, 'b, k, 6', 'm, rad',
        'displacement and rotation of the base per unit of each key rotation of the parent, '
        'about the root node',
    )  # fmt: skip
    segment_slope: Floats = _array(
        PLACING, 'n', 'rad/rad',
        'rotation of each segment per unit of key rotation',
    )  # fmt: skip
    segment_tip_slope: Floats = _array(PLACING, 'n', 'rad/rad', 'the same under a load at the tip')
    segment_chord: Floats = _array(
        PLACING, 'n, 3', 'm',
        'from its start to the start of the next one of its branch, or to its end, at rest',
    )  # fmt: skip
    segment_rest: Floats = _array(
        PLACING, 'n, 4', '',
        'orientation at rest as a quaternion w x y z',
    )  # fmt: skip
    segment_turn: Floats = _array(
        PLACING, 'n, k, 3', 'rad/rad',
        'rotation vector of each segment per unit of each key rotation of its branch',
    )  # fmt: skip

    branch_area: Floats = _array(LOADS, 'b', 'm^2', 'drag area')
    branch_speed: Floats = _array(
        LOADS, 'b', '',
        'wind speed at the branch over that at the anemometer',
    )  # fmt: skip
    branch_spread: Floats = _array(
        LOADS, 'b', 'm^2',
        'variance of the displacement of its pieces about that of the load centre, per squared '
        'unit of the first key rotations',
    )  # fmt: skip
    branch_lever: Floats = _array(LOADS, 'b', 'm', 'lever of its own load about its base')
    branch_projector: Floats = _array(
        LOADS, 'b, 6', '',
        'mean of 1 - t t^T over its pieces, t along a piece: xx yy zz xy xz yz',
    )  # fmt: skip
    branch_centre: Floats = _array(LOADS, 'b, 3', 'm', 'centre of the load from the root node')
    branch_coupling: Floats = _array(LOADS, 'b, 3, 3', 'm', 'moment about the root node per force')
    branch_load_mode: Floats = _array(
        LOADS, 'b, k, 3', 'm/rad',
        'displacement that the mean force does work on, per unit of each of its key rotations',
    )  # fmt: skip
    branch_damping_mode: Floats = _array(
        LOADS, 'b, k, 3', 'm/rad',
        'displacement whose velocity the drag damps',
    )  # fmt: skip
    branch_load_rotation: Floats = _array(
        LOADS, 'b, k, 3', 'rad/rad',
        'rotation of its loaded pieces',
    )  # fmt: skip
    branch_tip_mode: Floats = _array(LOADS, 'b, k, 3', 'm/rad', 'displacement of its tip')

    stiffness: Floats = _array(
        COORDINATES, 'm', '1/s^2',
        'squared circular frequency; of isolated branches their stiffness in N m/rad',
    )  # fmt: skip
    own_damping: Floats = _array(
        COORDINATES, 'm', '1/s',
        'damping by the wood; of isolated branches in N m s/rad',
    )  # fmt: skip
    weight: Floats = _array(
        COORDINATES, 'm', '1/s^2',
        'part of the stiffness by gravity, negative where the weight softens',
    )  # fmt: skip
    natural_frequencies: Floats = _array(
        COORDINATES, 'frequencies', 'Hz',
        'lowest natural frequencies of the tree without air',
    )  # fmt: skip

    shapes: Floats = _optional(
        COORDINATES, 'N, m', 'rad',
        'key rotations per unit of each coordinate',
    )  # fmt: skip
    projection: Floats = _optional(
        COORDINATES, 'm, N', '1/rad',
        'coordinates of key rotations: shapes^T mass',
    )  # fmt: skip
    relative_damping: Floats = _optional(
        COORDINATES, 'm', '',
        'damping ratio of each coordinate over that of the tree',
    )  # fmt: skip
    participation: Floats = _optional(
        COORDINATES, 'b, m', 'm^2',
        'mean square displacement of each load centre per unit of each coordinate',
    )  # fmt: skip
    key_limit: Floats = _optional(
        COORDINATES, 'N', 'N m',
        'largest moment of a push on each key rotation',
    )  # fmt: skip
    branch_compliance: Floats = _optional(
        COORDINATES, 'N, keys of a branch', 'rad/(N m)',
        'compliance of each isolated branch, the rows of its block',
    )  # fmt: skip
    shape_compliance: Floats = _optional(
        COORDINATES, 'm, m', '1/(N m)',
        'part of it that the coordinates have',
    )  # fmt: skip
    inertia_slopes: Floats = _optional(
        COORDINATES, 'q, q, q', '',
        'change of the inertia of the leading coordinates per unit of the last axis',
    )  # fmt: skip

    stream_shapes: Floats = _optional(
        STREAM, 'm, s', '',
        'coordinates per unit of each streamed coordinate, a length',
    )  # fmt: skip
    stream_projection: Floats = _optional(
        STREAM, 's, m', '',
        'streamed coordinates of coordinates',
    )  # fmt: skip
    stream_scale: Floats = _optional(
        STREAM, 's', 'm',
        'value of each streamed coordinate at the full scale of an int16',
    )  # fmt: skip
    stream_error: Floats = _optional(
        STREAM, '1', 'm',
        'largest error of the tip of a branch, in int16, in a wind of 13 m/s and its gusts',
    )  # fmt: skip

    most_pressure: float = 0.0
    most_energy: float = 0.0
    limit: Floats = _optional(
        TABLE, 'm', 'm^3',
        'largest load of a steady wind on each coordinate, per dynamic pressure',
    )  # fmt: skip
    motion: Floats = _optional(
        TABLE, 'm', 'm^2',
        'mean square velocity of the loaded pieces per squared rate of each coordinate',
    )  # fmt: skip
    harmonics: Floats = _optional(
        TABLE, f'{N_HARMONICS}, m', 'm^3',
        'load at rest per dynamic pressure, by spherical harmonics of the direction of the wind',
    )  # fmt: skip
    amount: Floats = _optional(
        TABLE, f'{N_AZIMUTHS}, m', '',
        'weights of the coordinates in the mean deflection',
    )  # fmt: skip
    levels: Floats = _optional(
        TABLE, f'{N_AZIMUTHS}, {N_LEVELS}', '',
        'mean deflection of the equilibria, ascending',
    )  # fmt: skip
    equilibrium: Floats = _optional(
        TABLE, f'{N_AZIMUTHS}, {N_LEVELS}, m', '',
        'coordinates in steady winds',
    )  # fmt: skip
    load: Floats = _optional(
        TABLE, f'{N_AZIMUTHS}, {N_LEVELS}, m', 'm^3',
        'load at the equilibria less that at rest',
    )  # fmt: skip
    cross_damping: Floats = _optional(
        TABLE, f'{N_AZIMUTHS}, {N_LEVELS}, m', 'm^4',
        'sum of the absolute damping of each coordinate by the rates of all others',
    )  # fmt: skip
    turning: Singles = _optional(
        TABLE, f'{N_AZIMUTHS}, {N_LEVELS}, m, m', 'm^3',
        'row i, column k: derivative of the load on coordinate k by coordinate i',
    )  # fmt: skip
    damping: Singles = _optional(
        TABLE, f'{N_AZIMUTHS}, {N_LEVELS}, m, m', 'm^4',
        'the same by the rate of coordinate i, over density and speed of the air',
    )  # fmt: skip
    lean: Singles = _optional(
        TABLE, f'{N_AZIMUTHS}, m, m', 'm^3',
        'change of turning by the vertical part of the direction of the wind',
    )  # fmt: skip
    steep_turning: Singles = _optional(
        TABLE, '2, m, m', 'm^3',
        'turning in winds straight down and straight up',
    )  # fmt: skip
    steep_damping: Singles = _optional(TABLE, '2, m, m', 'm^4', 'damping in these winds')

    inertia: Floats = _optional(
        ISOLATED, 'b', 'kg m^2',
        'inertia of each isolated branch (model branch)',
    )  # fmt: skip

    limb_delay: Ints = _optional(
        LIMBS, 'b', '',
        'number of the delay with which gusts reach each branch',
    )  # fmt: skip
    limb_spread: Floats = _optional(
        LIMBS, '1', 'm',
        'longest delay times the wind speed; 0 where the winds of limbs are given',
    )  # fmt: skip
    limb_share: Floats = _optional(LIMBS, 'delays', '', 'share of these limbs in the load')
    limb_harmonics: Floats = _optional(
        LIMB_LOADS, f'delays, {N_HARMONICS}, m', 'm^3',
        'their load at rest, by harmonics',
    )  # fmt: skip

    segment_mass: Floats = _optional(LIMP, 'n', 'kg', 'mass of each segment, with leaves')
    weight_slopes: Floats = _optional(
        LIMP, 'm, m', '1/s^2',
        'derivative of the force of the weight by the coordinates, at rest',
    )  # fmt: skip

    def __repr__(self) -> str:
        """Return tree, model and sizes on one line."""
        return (
            f'SwayModel of {self.tree.name}, model {self.settings.model}: '
            f'{len(self.stiffness)} coordinates, {len(self.branch_parent)} branches, '
            f'{self.tree.n_segments} segments'
        )

    @property
    def n_keys(self) -> int:
        """Number of key rotations, N."""
        return int(self.branch_keys.sum())

    @property
    def n_coordinates(self) -> int:
        """Number of coordinates, m."""
        return len(self.stiffness)

    @property
    def has_table(self) -> bool:
        """Whether a table has the wind load; else it is summed over the branches."""
        return self.levels.size > 0

    @property
    def is_isolated(self) -> bool:
        """Whether each branch is an oscillator of its own, as on the model ``branch``."""
        return self.inertia.size > 0

    @property
    def has_limbs(self) -> bool:
        """Whether gusts reach its limbs one after another."""
        return self.limb_delay.size > 0

    @property
    def is_limp(self) -> bool:
        """Whether its twigs turn so far that loads and inertia are those of its pose."""
        return self.segment_mass.size > 0

    @cached_property
    def branches(self) -> Records:
        """Records of the branches, (b,)."""
        room = self.branch_twist.shape[1]
        records = branches_at_rest(self.tree, self.branch_parent, self.branch_first, room)
        records['n_coordinates'] = self.branch_keys
        for name in ('base_segment', 'coordinate', *PLACED, *LOADED):
            records[name] = getattr(self, f'branch_{name}')
        return records

    def by_table(self) -> SwayModel:
        """Return the model by which trees that share a table are stepped, of limp ones too."""
        return replace(self, segment_mass=_NONE, weight_slopes=_NONE) if self.is_limp else self

    @cached_property
    def basis(self) -> StateBasis:
        """Return the basis in which the motion is streamed; isolated branches have none here."""
        from tree_sway.core.model.state_basis import StateBasis

        return StateBasis(
            self.shapes @ self.stream_shapes,
            self.stream_projection @ self.projection,
            self.stream_scale,
            float(self.stream_error[0]),
        )

    def arrays(self) -> dict[str, NDArray[Any]]:
        """Return the arrays by name, without absent ones; numbers are arrays without an axis."""
        found = {name: np.asarray(getattr(self, name), dtype=np.float64) for name in _NUMBERS}
        present = {name: getattr(self, name) for name in MEANINGS}
        return found | {name: each for name, each in present.items() if each is not _NONE}

    def native_arrays(self) -> dict[str, NDArray[Any]]:
        """Return the arrays by which the native core steps and places the tree."""
        tree = self.tree
        settings = self.settings
        return {
            **{n: each for n, each in self.arrays().items() if each.size and _is_native(n)},
            'gravity': np.array([settings.gravity]),
            'crown_coherence': np.array([settings.crown_coherence]),
            'tree_start': tree.start,
            'tree_end': tree.end,
            'tree_base_diameter': tree.base_diameter,
            'tree_tip_diameter': tree.tip_diameter,
        }

    def digest(self) -> str:
        """Digest of all arrays and numbers, 16 hexadecimal digits."""
        found = hashlib.sha256()
        for name, array in self.arrays().items():
            found.update(f'{name}{array.dtype.str}{array.shape}'.encode())
            found.update(np.ascontiguousarray(array).tobytes())
        return found.hexdigest()[:16]

    def check(self) -> None:
        """
        Check every array: its type, its shape, that it is finite, and that indices exist.

        Raises
        ------
        FormatError
            The first array that does not fit, with what is expected.

        """
        sizes = self._sizes()
        for name, meaning in MEANINGS.items():
            array = getattr(self, name)
            if array is _NONE and self._may_lack(meaning.group):
                continue
            shape = tuple(sizes.get(each, each) for each in meaning.shape)
            if array.dtype != TYPES[name] or not _fits(array.shape, shape):
                what = f'{array.dtype} of shape {array.shape}'
                raise _misfit(name, what, f'{TYPES[name]} of shape {shape}')
            _refuse_numbers(name, array)
        if (self.stiffness < 0.0).any():
            raise _misfit('stiffness', 'a negative number', 'those of a tree that stands')
        self._check_indices()

    def _may_lack(self, group: str) -> bool:
        return not {
            PLACING: True,
            LOADS: True,
            COORDINATES: not self.is_isolated,
            STREAM: not self.is_isolated,
            TABLE: self.has_table,
            ISOLATED: self.is_isolated,
            LIMBS: self.has_limbs,
            LIMB_LOADS: self.has_limbs and self.has_table,
            LIMP: self.is_limp,
        }[group]

    def _sizes(self) -> dict[int | str, int]:
        """Sizes that the names in shapes stand for."""
        count = len(self.branch_parent)
        twists = self.branch_twist.shape
        sizes: dict[int | str, int] = {'n': self.tree.n_segments, 'b': count, 'b + 1': count + 1}
        sizes |= {'k': twists[1] if len(twists) > 1 else 0, 'N': self.n_keys}
        sizes |= {'m': len(self.stiffness), 's': len(self.stream_scale)}
        return sizes | {'q': len(self.inertia_slopes)}

    def _check_indices(self) -> None:
        """Refuse indices by which a step would read past the end of an array."""
        n = self.tree.n_segments
        count = len(self.branch_parent)
        keys = self.branch_keys
        own = np.arange(count)
        last = np.clip(self.branch_parent, 0, count - 1)
        first = self.branch_first[:-1]
        end = self.branch_first[1:]
        seat = self.branch_base_segment
        room = self.branch_twist.shape[1]
        block = np.sort(self.branch_coordinate)
        followed = np.append(block[1:], self.n_keys)
        order = np.argsort(self.branch_coordinate)
        for name, holds, wanted in (
            ('branch_first', (end > first).all() and first[0] == 0, 'a rise from 0'),
            ('branch_first', end[-1] == n, 'n at the end'),
            ('branch_parent', self.branch_parent[0] == -1, '-1 for the stem'),
            ('branch_parent', (self.branch_parent[1:] >= 0).all(), 'one stem'),
            ('branch_parent', (self.branch_parent < own).all(), 'parents first'),
            ('branch_base_segment', seat[0] == -1, '-1 for the stem'),
            ('branch_base_segment',
             ((seat >= first[last]) & (seat < end[last]))[1:].all(), 'segments of parents'),
            ('branch_keys', ((keys >= 2) & (keys <= room)).all(), f'2 to {room}'),
            ('branch_twist', room in ROOMS, f'one of {ROOMS} rows for each branch'),
            ('branch_coordinate', block[0] == 0 and (followed - block == keys[order]).all(),
             'one block of key rotations for each branch'),
        ):  # fmt: skip
            if not holds:
                raise _misfit(name, 'an index that does not exist', wanted)

    @classmethod
    def of_arrays(
        cls, arrays: Mapping[str, NDArray[Any]], tree: Tree, species: Species, settings: Settings
    ) -> SwayModel:
        """
        Make a model of the arrays that `arrays` returns, and check it.

        Raises
        ------
        FormatError
            An array that is missing or unknown, or does not fit the others.

        """
        for name in sorted(arrays.keys() - {*MEANINGS, *_NUMBERS}):
            raise _misfit(name, 'an array that no model has', 'names of sway_model.md')
        for name in (*_NUMBERS, *_REQUIRED):
            if name not in arrays:
                raise _misfit(name, 'missing', 'an array of every model')
        for name, size in _NUMBERS.items():
            if arrays[name].size != size:
                raise _misfit(name, f'of shape {arrays[name].shape}', f'{size} numbers')
            _refuse_numbers(name, arrays[name])
        given: dict[str, Any] = {**arrays, 'drag_law': DragLaw(*arrays['drag_law'].tolist())}
        given |= {name: float(arrays[name]) for name in _NUMBERS if name != 'drag_law'}
        made = cls(tree=tree, species=species, settings=settings, **given)
        made.check()
        return made


def _is_native(name: str) -> bool:
    """Whether the native core needs an array or number."""
    if name in _NUMBERS or name in _NATIVE:
        return True
    return MEANINGS[name].group in (PLACING, TABLE, LIMBS, LIMB_LOADS, LIMP)


_NATIVE = ('stiffness', 'own_damping', 'shapes', 'branch_area', 'branch_speed')
"""Arrays of groups that the native core does not need as a whole."""


def _fits(shape: tuple[int, ...], wanted: tuple[int | str, ...]) -> bool:
    """Whether a shape is as wanted; a name in it stands for any size."""
    pairs = zip(shape, wanted, strict=False)
    return len(shape) == len(wanted) and all(
        isinstance(size, str) or size == own for own, size in pairs
    )


def _refuse_numbers(name: str, array: NDArray[Any]) -> None:
    """Refuse numbers that no tree has: not finite, or so great that poses would not be."""
    if not (np.abs(array) < GREATEST).all():
        what = 'a number that no tree has, or that is not finite'
        raise _misfit(name, what, f'numbers below {GREATEST:g}')


def _misfit(name: str, what: str, wanted: str) -> FormatError:
    cure = 'convert the tree again by tree-sway convert'
    return FormatError(f"array '{name}': {what}; expected: {wanted}", where='model', cure=cure)


_NUMBERS_OF: dict[Any, type] = {'Floats': np.float64, 'Singles': np.float32, 'Ints': np.int64}
"""Type of the numbers of an array by its annotation."""

_NUMBERS = {
    'drag_law': 3, 'damping_ratio': 1, 'mass': 1, 'most_pressure': 1, 'most_energy': 1,
}  # fmt: skip
"""Numbers of a model, and how many there are of each."""

_FIELDS = {each.name: each for each in fields(SwayModel) if each.metadata}

MEANINGS: dict[str, Meaning] = {name: each.metadata['meaning'] for name, each in _FIELDS.items()}
"""Group, shape, unit and meaning of every array, by name."""

TYPES: dict[str, type] = {name: _NUMBERS_OF[each.type] for name, each in _FIELDS.items()}
"""Type of the numbers of every array, by name."""

_REQUIRED = [name for name, each in _FIELDS.items() if each.default_factory is MISSING]
