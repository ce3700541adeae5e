# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The simulator of a tree: the order of work of a step."""

from __future__ import annotations

from array import array
from collections.abc import Callable, Sequence
from dataclasses import dataclass
import math
from typing import NamedTuple, TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.checks import (
    array_to_fill,
    array_to_read,
    refuse_time_step,
    three_numbers,
    whole,
)
from tree_sway.core.model import SwayModel
from tree_sway.core.native import NotCopied
from tree_sway.core.run.assembly import bank_of
from tree_sway.core.run.bank import Bank
from tree_sway.core.run.outcome import Outcome
from tree_sway.core.species import WOOD_SPREAD
from tree_sway.core.tree import ends_of_poses
from tree_sway.core.wind import is_wind
from tree_sway.errors import nearest, ParameterError

if TYPE_CHECKING:
    from tree_sway.core.model import StateBasis
    from tree_sway.core.run.clamp_watch import ClampWatch
    from tree_sway.core.run.crown_gusts import CrownGusts
    from tree_sway.core.run.far_crown import FarCrown
    from tree_sway.core.run.pushes import Spring, Touch
    from tree_sway.core.run.tuning import LiveTuning, Tuning
    from tree_sway.core.tree_state import TreeState
    from tree_sway.core.wind.gusts import GustHistory

Motion: TypeAlias = Callable[[], Floats]
"""Function that returns the present coordinates of trees in a basis, (t, m)."""


@dataclass
class Counts:
    """
    Counts of the steps since the start.

    ``refused``: the wind was not finite or faster than the limit, and the last one was used;
    ``clamped``: loads at the limit of the model; ``restarted``: the motion was not finite, and the
    tree continued from rest; ``refused_pushes``: calls of `SwaySimulator.push` that were refused;
    ``reduced``: times that a tree whose steps stayed clamped continued from rest on fewer
    coordinates (`clamp_watch`).
    """

    steps: int = 0
    refused: int = 0
    clamped: int = 0
    restarted: int = 0
    refused_pushes: int = 0
    reduced: int = 0


class SwaySimulator(NotCopied):
    """
    A tree that sways.

    Parameters
    ----------
    prepared
        Model of the tree, as `prepare` makes it; `make_simulator` does both.

    Examples
    --------
    >>> sim = SwaySimulator(prepare(tree, model="branch"))
    >>> for wind in record:
    ...     sim.step(wind, 1 / 60)
    ...     poses = sim.place()

    """

    def __init__(self, prepared: SwayModel) -> None:
        """Make the tree at rest."""
        self.models = (prepared,)
        """Prepared model of the tree."""
        self.tree = tree = prepared.tree
        self.settings = prepared.settings
        self.gusts: GustHistory | None = None
        """No gusts travel within a tree."""
        self.counts = Counts()
        self._bank: Bank = bank_of(prepared)
        self._advance = self._bank.oscillators.advance
        self._max_wind = self.settings.max_wind
        self._gusts: CrownGusts | None = None
        if prepared.has_limbs and self._bank.oscillators.loads is not None:
            from tree_sway.core.run.crown_gusts import CrownGusts

            self._gusts = CrownGusts(prepared, self._bank.oscillators)
        self._far: FarCrown | None = None
        if self.settings.is_far:
            from tree_sway.core.run.far_crown import FarCrown

            self._far = FarCrown(prepared, self._bank, self._gusts, self.settings)
            if self.settings.gusts == 'expected':
                self._bank.oscillators.tunable.spread_wood(WOOD_SPREAD)
        self._tuning: LiveTuning | None = None
        self._touch: Touch | None = None
        self._dt = math.nan
        self._watch: ClampWatch | None = None
        self._stored = array('d', (0.0, 0.0, 0.0))
        self._wind = np.frombuffer(self._stored)  # which a number is written to in twice the time
        self._expected = (prepared.n_keys,)
        self._poses = np.zeros((tree.n_segments, 7))
        self._filled = self._poses
        self._origin = tree.start[0].copy()
        self._highest = int(np.argmax(tree.end[:, 2]))

    def __repr__(self) -> str:
        """Return tree, model and number of steps on one line."""
        kind = type(self).__name__
        return f'{kind} of {self.tree.name}, model {self.model}: {self.counts.steps} steps'

    @property
    def model(self) -> str:
        """
        Model in use: its name, or its number of coordinates.

        A limp tree may solve fewer than asked for, and has both numbers, as in ``54/60``.
        """
        asked = self.settings.model
        (model,) = self.models
        solved = len(model.stiffness)
        has_fewer = model.is_limp and isinstance(asked, int) and solved < asked
        return f'{solved}/{asked}' if has_fewer else str(asked)

    @property
    def name(self) -> str:
        """Name of the tree."""
        return self.tree.name

    @property
    def wind_told(self) -> str:
        """By which gusts it sways, as `Settings.wind_told`, and how much of them is measured."""
        told = self.settings.wind_told
        share = '' if self._far is None else f', {self._far.wind.told:.0%} of their power told'
        return told + share

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the trees: of this one."""
        return (self.tree.name,)

    @property
    def mass(self) -> float:
        """Mass of wood and leaves in [kg]."""
        return self.models[0].mass

    @property
    def banks(self) -> tuple[Bank, ...]:
        """Records and oscillators of the tree, as `models`."""
        return (self._bank,)

    @property
    def simulators(self) -> tuple[SwaySimulator, ...]:
        """Simulators of the trees that share no table: this one."""
        return (self,)

    @property
    def groups(self) -> list[TreeGroup]:
        """Trees that share a table, or a tree alone: this one."""
        return [TreeGroup(self, np.zeros(1, dtype=np.int64), self._in_basis)]

    def _in_basis(self, basis: StateBasis) -> Motion:
        """Return a function that finds the motion in a basis, (1, m)."""
        oscillators = self._bank.oscillators
        return lambda: np.asarray(basis.projection @ oscillators.rotations())[None]

    @property
    def places(self) -> Floats:
        """Place of each tree: x y z of its root node [m], its turn [rad], its scale, (1, 5)."""
        return np.array([[*self._origin, 0.0, 1.0]])

    @property
    def speeds(self) -> Floats:
        """Wind of each tree over that of its kind, (1,)."""
        return np.ones(1)

    def segments_of(self, name: str) -> slice:
        """Return the rows of a tree in the pose block; a `ParameterError` for another name."""
        return rows_of_tree(name, self.names, [0, self.tree.n_segments], self.name)

    @property
    def wind(self) -> Floats:
        """Wind of the last step in [m/s], (3,)."""
        return self._wind.copy()

    def frequencies(self, count: int = 10) -> Floats:
        """
        Lowest natural frequencies of the tree in [Hz], without air, (count,) or fewer.

        On the model ``branch`` they are those of the isolated branches. A `ParameterError` refuses
        a count that is no whole number above 0.
        """
        count = whole('count', count, 1, 10**9)
        if self.settings.model == 'branch':
            tunable = self._bank.oscillators.tunable
            circular = np.sort(np.sqrt(tunable.stiffness / tunable.inertia))[:count]
            return np.asarray(circular / (2.0 * np.pi))
        return self.models[0].natural_frequencies[:count]

    def digest(self) -> str:
        """Digest of tree, species, settings and tuning."""
        from tree_sway.core.tree_state import digest_of

        tuned = self._tuning_of_state
        return digest_of(self.tree, self.models[0].species, self.settings, *tuned)

    @property
    def _tuning_of_state(self) -> tuple[Tuning, ...]:
        """What was tuned and is not in the state."""
        return () if self._tuning is None else self._tuning.changes

    def _memory(self) -> tuple[Floats, ...]:
        """Return views of the state, the wind of the last step first."""
        crown = () if self._gusts is None else self._gusts.wind.memory()
        far = () if self._far is None else self._far.wind.memory()
        return self._wind, *self._bank.oscillators.memory(), *crown, *far

    def state(self) -> TreeState:
        """Return a copy of the state."""
        from tree_sway.core.tree_state import TreeState, values_of

        return TreeState(self.tree.name, self.digest(), self.model, values_of(self._memory()))

    def set_state(self, state: TreeState) -> None:
        """
        Continue from a state.

        Raises a `StateError` for a different tree or model, or a state that is not finite, and
        keeps the present state.
        """
        from tree_sway.core.tree_state import fill_memory, refuse_other_state

        refuse_other_state(state, self.state())
        fill_memory(self._memory(), state.values)
        self._dt = math.nan  # the state determines which coordinates the step solves

    def rotations(self) -> Floats:
        """Key rotations in [rad], (N,), branch after branch; valid until the next step."""
        shown = self._bank.oscillators.rotations()
        return shown if self._touch is None else shown + self._touch.residual

    def place_rotations(self, rotations: Floats, out: Floats | None = None) -> Floats:
        """Place every segment by key rotations (N,), (n, 7); a new array if out is None."""
        out = self._to_fill(out)
        read = array_to_read('rotations', rotations, self._expected)
        self._bank.place(read, out)
        return out

    def step(self, wind_mean: ArrayLike, dt: float) -> int:
        """
        Advance one step.

        Parameters
        ----------
        wind_mean
            Mean of the wind over the step at the anemometer's height, the way the air goes, in
            [m/s], (3,).
        dt
            Length of the step in [s].

        Returns
        -------
        int
            0, or the sum of bits of `Outcome`.

        Raises
        ------
        ParameterError
            A step that is not above 0, or longer than `LONGEST_STEP`.

        """
        x, y, z = three_numbers('wind', wind_mean)
        if dt != self._dt or self._tuning is not None:
            self._change_step(dt)
        counts = self.counts
        counts.steps += 1
        status = 0
        if is_wind(x, y, z, self._max_wind):
            stored = self._stored
            stored[0] = x
            stored[1] = y
            stored[2] = z
        else:
            status = Outcome.WIND_REFUSED
            counts.refused += 1
            x, y, z = self._stored
        if self._far is not None:
            x, y, z = self._far.push(x, y, z, dt)
        if self._gusts is not None:
            self._gusts.push(x, y, z, dt)
        outcome = self._advance(x, y, z)
        if outcome == 0 and self._touch is None:
            return status
        if outcome > 0:
            self._watch_clamped(dt)
        return status | self._count(outcome) | self._step_pushes(dt)

    def push(
        self, segment: int, force: ArrayLike | Spring, seconds: float, *, along: float = 0.5
    ) -> None:
        """
        Push or pull at a segment while the tree sways.

        The force moves with the tree and keeps its direction. A new force on the same segment
        replaces the one before, so that dragging a branch is a series of calls; after the last one
        the tree swings freely. A state has no pushes.

        Parameters
        ----------
        segment
            Number of the segment.
        force
            Force in [N], (3,), or a `Spring` to a place.
        seconds
            Duration of the force from the next step on in [s].
        along
            Place on the segment, as a share of its length from the root side.

        Raises
        ------
        ParameterError
            A segment that does not exist, a force that is not finite, a time that is not above 0,
            or the model ``branch``; it is counted as `Counts.refused_pushes`, and nothing changes.

        """
        from tree_sway.core.run.pushes import Touch

        try:
            touch = self._touch or Touch(self.tree, self._bank)
            touch.add(segment, force, seconds, along)
        except ParameterError:
            self.counts.refused_pushes += 1
            raise
        self._touch = touch

    @property
    def push_load(self) -> Floats:
        """Force [N] and moment about the root node [N m] of the last step's pushes, (6,)."""
        return np.zeros(6) if self._touch is None else self._touch.load.copy()

    @property
    def pushed(self) -> dict[int, Touch]:
        """Pushes on the tree under the number 0, until their effect is gone."""
        return {} if self._touch is None else {0: self._touch}

    def _step_pushes(self, dt: float) -> int:
        """Add the effect of pushes over the last step [s]; returns bits as `step`."""
        if self._touch is None or self._touch.is_gone:
            self._touch = None
            return Outcome.OK
        return self._count(self._touch.step(lambda: self.place(self._poses), dt))

    def _count(self, clamped: int) -> int:
        """Count the result of `advance`; returns bits as `step`."""
        if clamped > 0:
            self.counts.clamped += clamped
            return Outcome.LOAD_CLAMPED
        if clamped < 0:
            self._bank.oscillators.reset()
            self.counts.restarted += 1
            return Outcome.RESTARTED
        return Outcome.OK

    def _watch_clamped(self, dt: float) -> None:
        """Show fewer coordinates if the steps of the tree stay clamped, and no push bends it."""
        oscillators = self._bank.oscillators
        if self._touch is not None or not getattr(oscillators, 'is_bent_too_far', False):
            return
        from tree_sway.core.run.clamp_watch import ClampWatch, fewer

        if self._watch is None:
            self._watch = ClampWatch()
        if self._watch.is_stuck(self.counts.steps, dt):
            count = fewer(self._bank.n_shown)
            if count < self._bank.n_shown:
                self._show_at_most(count)
                self.counts.reduced += 1

    def _show_at_most(self, count: int) -> None:
        """Go on from rest without the coordinates of a table beyond a count, until `reset`."""
        keep_only = getattr(self._bank.oscillators, 'keep_only', None)
        if keep_only is not None and count < self._bank.n_shown:
            keep_only(count)

    def place(self, out: Floats | None = None) -> Floats:
        """
        Place every segment.

        Parameters
        ----------
        out
            Array to write to, (n, 7) float64, for speed; a new array if None.

        Returns
        -------
        Floats
            Pose block: x y z of each segment's root-side node in [m], quaternion x y z w, x axis
            along the segment.

        Raises
        ------
        ParameterError
            An array of a wrong shape or type.

        """
        if out is not self._filled:
            out = self._to_fill(out)
        if self._touch is None:
            self._bank.place_now(out)
            return out
        return self.place_rotations(self.rotations(), out)

    def _to_fill(self, out: Floats | None) -> Floats:
        if out is None:
            return np.empty(self._poses.shape)
        if out is not self._filled:
            self._filled = array_to_fill('out', out, self._poses.shape)
        return out

    @property
    def tip_displacement(self) -> Floats:
        """Displacement of the highest tip from rest in [m], (3,)."""
        top = slice(self._highest, self._highest + 1)
        tip = ends_of_poses(self.place(self._poses)[top], self.tree.length[top])[1][0]
        return np.asarray(tip - self.tree.end[self._highest])

    @property
    def wind_moment(self) -> Floats:
        """Moment of the last step's wind on the tree at rest about its root node, [N m], (3,)."""
        return self._bank.wind_moment()

    def check_tuning(self, **changes: float) -> Tuning:
        """Check changes as `tune`; returns all values after the changes."""
        from tree_sway.core.run.tuning import LiveTuning

        if self._tuning is None:
            tunable = self._bank.oscillators.tunable
            ratio = self.models[0].damping_ratio
            self._tuning = LiveTuning(tunable, self.settings, ratio)
        return self._tuning.changed(**changes)

    def tune(self, **changes: float) -> None:
        """
        Change the tree while it sways; the change takes half a second.

        Parameters
        ----------
        **changes
            Fields of `Tuning`: ``damping_ratio``, ``stiffness_factor`` or ``gravity``. Others
            stay.

        Raises
        ------
        ParameterError
            A value that is out of range or impossible for this tree; nothing changes.

        """
        goal = self.check_tuning(**changes)
        if self._tuning is not None:
            self._tuning.go_to(goal)

    def _glide(self, dt: float) -> bool:
        """Continue a transition of `tune`; returns whether the coefficients have changed."""
        return self._tuning is not None and self._tuning.step(dt)

    def reset(self) -> None:
        """Return to rest, with no wind; the counts stay."""
        self._bank.oscillators.reset()
        if self._gusts is not None:
            self._gusts.wind.reset()
        if self._far is not None:
            self._far.wind.reset()
        self._touch = self._watch = None
        self._dt = math.nan
        self._wind[:] = 0.0

    def _change_step(self, dt: float) -> None:
        """Refill the coefficients if the step [s] or the tuning has changed."""
        is_changed = dt != self._dt
        if is_changed:
            refuse_time_step(dt)
        # A transition advances with every step, also where the length of the step varies.
        if self._glide(dt) or is_changed:
            self._set_step(dt)

    def _set_step(self, dt: float) -> None:
        self._bank.oscillators.set_step(dt)
        self._dt = dt


class TreeGroup(NamedTuple):
    """
    Trees that share a table, or a tree alone.

    Parameters
    ----------
    simulator
        Simulator of the kind in its own frame, or of the tree.
    numbers
        Numbers of the trees, (t,).
    in_basis
        Function that takes a basis, and returns one that finds the present motion in it, (t, m).

    """

    simulator: SwaySimulator
    numbers: Ints
    in_basis: Callable[[StateBasis], Motion]


def rows_of_tree(name: str, names: Sequence[str], ends: Sequence[int], where: str) -> slice:
    """Return the rows of a tree in a pose block whose trees end at rows, (t + 1,)."""
    if name not in names:
        cure = f'{nearest(name, names)} use one of: {", ".join(names[:20])}'
        raise ParameterError(f"no tree is called '{name}'", where=where, cure=cure)
    number = names.index(name)
    return slice(int(ends[number]), int(ends[number + 1]))
