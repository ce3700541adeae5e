# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Simulation of a tree in a wind from rest in one call, without clock and ROS."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from copy import deepcopy
from dataclasses import replace
import itertools
import operator
from typing import Any, NamedTuple, Protocol, runtime_checkable, TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.checks import (
    LONGEST_STEP,
    refuse_named_columns,
    refuse_other_kind,
    within,
)
from tree_sway.core.model import ModelCache, PREPARED
from tree_sway.core.run import Counts, SwaySimulator
from tree_sway.core.scene import Run, simulator_of, solved
from tree_sway.core.settings import Settings, settings_with
from tree_sway.core.setup import TreeReductions
from tree_sway.core.tree import GrownTree, tips_of_poses, Tree, tree_and_species
from tree_sway.core.wind import (
    FASTEST_WIND,
    LONGEST_HOLD,
    shorter_than,
    simulate_turbulence,
    WindAverage,
    WindGate,
    WindIntake,
)
from tree_sway.core.wind.gusts import USUAL_COHERENCE
from tree_sway.errors import ParameterError
from tree_sway.simulation.interpolated import interpolated_means
from tree_sway.simulation.strength_use import StrengthGauge, StrengthUse
from tree_sway.simulation.sway_record import SwayRecord

if TYPE_CHECKING:
    from tree_sway.twin import ObservedTree
    from tree_sway.twin.camera import FilmedMotion, FilmedTree

_MAX_STEPS = 6_000_000
"""Largest number of steps, all of which are in the memory: more than a day at 60 Hz."""
_CHUNK = 4096
"""Number of samples of a record that are plain numbers at a time."""
USUAL_RATE = 60.0
"""Steps per second, unless they are given [Hz]."""
_AT_USUAL_RATE = f'the wind is taken as {USUAL_RATE:g} means per second; rate=20 if it has 20'
_EXPECTED = (
    'the band lies about the motion that is expected in gusts which do not reach all of the crown '
    f'at once (crown_coherence {USUAL_COHERENCE:g}): less than in one wind'
)
_UNCHECKED = 'a clock that is up to 1 s off is hardly told: synchronise those of wind and motion'


class PlacedMotion(NamedTuple):
    """
    Record of a motion sensor, and its place as `place_on` takes it.

    Times are in [s] after the start of the wind, (n,); quantities those of `ObservedTree.replay`.
    """

    name: str
    at: str | float
    time: Floats
    acceleration: Floats | None = None
    rate: Floats | None = None
    orientation: Floats | None = None


@runtime_checkable
class WindSamples(Protocol):
    """Wind over time, as `read_wind` returns it."""

    @property
    def time(self) -> Floats:
        """Return the times in [s], rising, (m,)."""

    @property
    def velocity(self) -> Floats:
        """Velocities in [m/s], (m, 3)."""


def simulate(
    tree: Tree | GrownTree,
    wind: WindSamples | ArrayLike,
    *,
    rate: float | None = None,
    seconds: float | None = None,
    branches: Sequence[int] | None = None,
    settings: Settings | None = None,
    motion: Sequence[PlacedMotion] = (),
    film: FilmedMotion | None = None,
    band: bool = False,
    progress: Callable[[float], object] = lambda share: None,
    **changes: Any,
) -> SwayRecord:
    """
    Let a tree sway in a wind from rest.

    Parameters
    ----------
    tree
        A tree, or one with its species.
    wind
        Record with ``time`` and ``velocity``, which passes the gate and decays in gaps like a live
        wind (`Run`); or the mean wind of each step in [m/s], (t, 3).
    rate
        Steps per second in [Hz]; 60 if None, which a note says for a wind of steps.
    seconds
        Duration of the simulation in [s]; that of the wind if None.
    branches
        Branches whose tips are recorded; the one with the highest tip if None.
    settings, **changes
        Settings, as for `make_simulator`.
    motion
        Records of motion sensors on the real tree, which the motion then follows
        (`ObservedTree`).
    film
        Film of the real tree, which the motion follows too (`FilmedTree`).
    band
        Whether to find where the real tree is for 80 % of the time, too (`ObservedTree.band`).
    progress
        Function called after each step with the share of all that is done.

    Returns
    -------
    SwayRecord
        Wind, tips, moment and strain at the base, one row per step.

    Raises
    ------
    ParameterError
        A wind that is empty, not finite or of a wrong shape, an unknown branch, or a setting out
        of its range.
    TreeError
        A tree that buckles.

    """
    wind = _checked(
        tree_and_species(tree)[0], wind, USUAL_RATE if rate is None else rate, seconds, branches
    )
    rig = Rig(tree, settings, motion=motion, film=film, band=band, **changes)
    return rig.run(wind, rate=rate, seconds=seconds, branches=branches, progress=progress)


class Rig:
    """A tree set up once for several simulations from rest, as by `simulate`."""

    def __init__(
        self,
        tree: Tree | GrownTree,
        settings: Settings | None = None,
        motion: Sequence[PlacedMotion] = (),
        *,
        film: FilmedMotion | None = None,
        tolerance: float = 0.005,
        cache: ModelCache | None = PREPARED,
        band: bool = False,
        **changes: Any,
    ) -> None:
        """Reduce the tree, once for the simulator and for its strain."""
        bare, species = tree_and_species(tree)
        chosen = settings_with(settings, changes)
        self.tree = bare
        self.reductions = TreeReductions(bare, species, solved(chosen))
        refuse_other_kind('motion', motion, Sequence, 'give a list of PlacedMotion')
        for each in motion:
            refuse_other_kind('motion', each, PlacedMotion, 'give a list of PlacedMotion')
        self.motion = motion
        self.simulator: SwaySimulator
        self.observed: ObservedTree | None = None
        """The same simulator, if it follows sensors or has a band."""
        self.film = film
        self.filmed: FilmedTree | None = None
        in_one_wind = not chosen.is_far and chosen.crown_coherence > USUAL_COHERENCE
        self._is_expected = band and in_one_wind and not motion and film is None
        observed: dict[str, Any] = {
            'settings': chosen,
            'at': {each.name: each.at for each in motion},
            'cache': cache,
            'has_band': band,
        }
        if film is not None:
            from tree_sway.twin.camera import FilmedTree

            self.filmed = FilmedTree(tree, camera=film.camera, **observed)
            self.simulator = self.observed = self.filmed
        elif motion or band:
            from tree_sway.twin import ObservedTree

            self.simulator = self.observed = ObservedTree(tree, **observed)
        else:
            auto = {'tolerance': tolerance} if chosen.model == 'auto' else {}
            self.simulator = simulator_of(self.reductions, cache=cache, **auto)

    def run(
        self,
        wind: WindSamples | ArrayLike,
        *,
        rate: float | None = None,
        seconds: float | None = None,
        branches: Sequence[int] | None = None,
        strained: int | None = None,
        progress: Callable[[float], object] = lambda share: None,
    ) -> SwayRecord:
        """Sway the tree in a wind from rest, as `simulate`; ``strained`` as in `WoodStrain`."""
        tree = self.tree
        simulator = self.simulator
        observed = self.observed
        of_steps = rate is None and not isinstance(wind, WindSamples)
        rate = USUAL_RATE if rate is None else rate
        wind = _checked(tree, wind, rate, seconds, branches)
        chosen = _chosen(tree, branches)
        if observed is not None:
            observed.set_rate(rate)
            for each in self.motion:
                observed.replay(
                    each.name,
                    each.time,
                    acceleration=each.acceleration,
                    rate=each.rate,
                    orientation=each.orientation,
                )
        simulator.reset()
        if self.film is not None and self.filmed is not None:
            for picture in self.film.pictures:
                self.filmed.film(*picture)
        before = replace(simulator.counts)
        gauge = StrengthGauge(self.reductions, strained)
        per_rotation = _moment_per_rotation(self.reductions)
        poses = np.empty((tree.n_segments, 7))
        rows = list[tuple[Floats, ...]]()
        bands = list[tuple[Floats, Floats]]()
        rest = tips_of_poses(tree, simulator.place(), chosen)

        def measure(end: int, mean: Floats) -> None:
            tips = rest
            if len(chosen):
                tips = tips_of_poses(tree, simulator.place(poses), chosen) - rest
            rotations = simulator.rotations()
            moment = rotations[: len(per_rotation)] @ per_rotation
            rows.append((mean, tips, moment, gauge.read(rotations, moment)[chosen]))
            if observed is not None and observed.members is not None:
                load = observed.load_band(per_rotation)
                bands.append((tips + observed.band(chosen.tolist()), moment + load))

        count, steps = _steps(simulator, wind, rate, measure)
        short = ''
        if seconds is not None:
            short = shorter_than(count / rate, seconds)
            count = min(count, max(round(seconds * rate), 1))
        refuse_too_many_steps(count, rate)
        for done, _ in enumerate(itertools.islice(steps, count), start=1):
            progress(done / count)
        means, tips, moment, strain = (np.array(column) for column in zip(*rows, strict=True))
        radius = 0.5 * float(tree.base_diameter[0])
        per_moment = radius / (self.reductions.species.modulus * np.pi / 4.0 * radius**4)
        tip_band, moment_band = map(np.array, zip(*bands, strict=True)) if bands else (None, None)
        return SwayRecord(
            tree.name, simulator.model, np.arange(1, count + 1) / rate, means, chosen,
            tuple(tree.branch_names[branch] for branch in chosen), tips, moment,
            per_moment * np.stack([-moment[:, 1], moment[:, 0]], axis=1), strain, gauge.use(),
            (
                *filter(None, [short]),
                *([_AT_USUAL_RATE] if of_steps else []),
                *getattr(wind, 'notes', ()),
                *([_EXPECTED] if self._is_expected else []),
                *_doubts(simulator, before),
                *_other_times(self.motion, count / rate),
                *_said_by_sensors(observed),
                *filter(None, [self.filmed.said if self.filmed is not None else '']),
            ),
            tip_band,
            moment_band,
            learned=None if observed is None else observed.learned,
        )  # fmt: skip

    def strength_curve(
        self, speeds: ArrayLike, *, rng: np.random.Generator, seconds: float = 600.0,
        rate: float = 30.0, height: float = 10.0, intensity: float | None = None,
        strained: int | None = None,
    ) -> list[StrengthUse]:  # fmt: skip
        """
        Find the shares of strength used in the largest gust of each of some mean speeds.

        Loads in gusts of a stand have a skew that no peak factor of their deviation tells: one of
        Davenport (1964) for ten minutes is a fifth too low there. So all of that time is solved.

        Parameters
        ----------
        speeds
            Mean speeds in [m/s], (n,).
        rng
            Random numbers of the turbulence; all speeds have the same gusts, faster. A copy is
            used: the gusts are those that `simulate_turbulence` makes from it.
        seconds
            Length of each wind in [s]; ten minutes, the time of a mean wind (WMO guide no. 8), if
            left out.
        rate
            Steps per second [Hz].
        height, intensity
            Height and intensity of the turbulence, as in `Turbulence`.
        strained
            Number of branches whose wood is looked at, the stem first; all if None.

        """
        used = []
        for speed in np.asarray(speeds, dtype=np.float64).tolist():
            wind = simulate_turbulence(
                speed, rate=rate, duration=seconds, rng=deepcopy(rng), height=height,
                intensity=intensity,
            )  # fmt: skip
            record = self.run(wind, rate=rate, branches=(), strained=strained)
            used.append(record.strength)
        return used


def _other_times(motion: Sequence[PlacedMotion], seconds: float) -> Iterator[str]:
    """Report sensors whose samples are all before or after the simulated time, 0 to seconds."""
    for each in motion:
        if len(each.time) and not (each.time[-1] >= 0.0 and each.time[0] <= seconds):
            first = float(each.time[0])
            last = float(each.time[-1])
            yield (
                f'{each.name}: its samples are of {first:.6g} to {last:.6g} s, and the wind of 0 '
                f'to {seconds:.6g} s: shift one of them, as by --motion-starts'
            )


def _said_by_sensors(simulator: ObservedTree | None) -> tuple[str, ...]:
    """Report which sensors moved the tree, and what they told, one sentence each."""
    if simulator is None:
        return ()
    found = list(simulator.problems)
    tracks = simulator.observer.tracks
    for track in tracks:
        counts = track.sensor.counts
        if track.in_use:
            noted = list(track.alignment.notes) if track.alignment else []
            noted += [_UNCHECKED] if len(tracks) == 1 else []
            told = f'{counts.accepted} samples followed, {counts.refused} refused'
            found.append('; '.join([f'{track.sensor.name}: {told}', *noted]))
    if simulator.late_wind.note:
        found.append(simulator.late_wind.note)
    if (fit := simulator.observer.fit) is not None:
        found.append(
            f'the tree is {fit.stiffness:.3g} times as stiff as the model, within '
            f'{100.0 * fit.stiffness_error:.0f} %, its damping {fit.damping:.2g} times, within '
            f'{100.0 * fit.damping_error:.0f} %'
        )
    found += [str(each) for each in simulator.sway_changes]
    return tuple(found)


def _doubts(simulator: SwaySimulator, before: Counts) -> tuple[str, ...]:
    """Report what makes the motion since some counts doubtful, one sentence each."""
    now = simulator.counts
    found = [bank.doubt for bank in simulator.banks if bank.doubt]
    n_steps = now.steps - before.steps
    if refused := now.refused - before.refused:
        found.append(
            f'the wind of {refused} of {n_steps} steps was refused, faster than '
            f'{simulator.settings.max_wind:g} m/s: the last one before was held'
        )
    if simulator.banks[0].n_shown == 0:
        found.append(f"model '{simulator.model}' has no coordinates: the tree stands still")
    solved, slash, asked = simulator.model.partition('/')
    if slash:
        found.append(f'twigs hang or whip: {solved} of {asked} coordinates are solved, the slower')
    if now.reduced > before.reduced:
        found.append(
            'steps stayed clamped to the limit of the model, and coordinates were left out: '
            f"{simulator.banks[0].n_shown} moved at the end; compare with model 'full'"
        )
    elif now.clamped > before.clamped:
        found.append(
            f'{now.clamped - before.clamped} loads in {n_steps} steps were clamped to the limit '
            'of the model'
        )
    if now.restarted > before.restarted:
        n_restarts = now.restarted - before.restarted
        found.append(f'the motion was not finite and continued from rest, {n_restarts} times')
    return tuple(found)


def _moment_per_rotation(reductions: TreeReductions) -> Floats:
    """
    Bending moment at the base of the stem per key rotation of it, in [N m/rad], (k, 3).

    It follows from the curvature of the stem's shapes there, so it is the moment of wind and
    inertia together that a strain gauge measures.
    """
    stem = reductions.reduced.models[0]
    along = stem.beam.tangent[0]
    found = []
    for field in stem.fields:
        across = field.curvature[0] - np.outer(field.curvature[0] @ along, along)
        bending = stem.beam.second_moment[0][:, None] * across
        found.append(reductions.species.modulus * np.polyfit(stem.beam.place[0], bending, 2)[-1])
    return np.array(found)


def refuse_too_many_steps(count: float, rate: float) -> None:
    """Raise a `ParameterError` for more than `_MAX_STEPS` steps at a rate in [Hz]."""
    if count > _MAX_STEPS:
        raise ParameterError(
            f'{count / rate:g} s at {rate:g} Hz are {count:.3g} steps',
            cure=f'give at most {_MAX_STEPS} steps, such as a day at 60 Hz',
        )


def _checked(
    tree: Tree, wind: WindSamples | ArrayLike, rate: float, seconds: float | None,
    branches: Sequence[int] | None,
) -> WindSamples | Floats:  # fmt: skip
    """Return a wind, the means of steps as numbers; refuse what `Rig.run` cannot simulate."""
    within('rate', rate, 1.0 / LONGEST_STEP, 10_000.0, 'Hz')
    if seconds is not None:
        within('seconds', seconds, 0.0, 1e9, 's', above=True)
    _chosen(tree, branches)
    if isinstance(wind, WindSamples):
        duration = _duration(wind)
        if duration * rate + 1e-6 >= 1.0:
            return wind
        what = f'a wind record of {duration:g} s'
    else:
        refuse_named_columns('wind', wind)
        try:
            means = np.atleast_1d(np.asarray(wind, dtype=np.float64))
        except (TypeError, ValueError, OverflowError):
            text = ' '.join(repr(wind).split())[:80]
            cure = 'open a file by read_wind, or give the mean of each step, (t, 3)'
            raise ParameterError(f'{text} is no wind', where='wind', cure=cure) from None
        what = f'wind of shape {means.shape}'
        if not np.isfinite(means).all():
            what = 'wind that is not finite'
        elif means.ndim == 2 and len(means) and means.shape[1] == 3:
            fastest = float(np.linalg.norm(means, axis=1).max())
            if fastest <= FASTEST_WIND:
                return means
            what = f'wind of {fastest:.4g} m/s, above {FASTEST_WIND:g}'
    cure = (
        'give a record of one step at least, as by read_wind or simulate_turbulence, or the '
        'mean of each step, (t, 3): np.full((3600, 3), (8, 0, 0)) is a minute of 8 m/s to the '
        'east at 60 Hz'
    )
    raise ParameterError(what, where='wind', cure=cure)


def _duration(wind: WindSamples) -> float:
    """Return the time of a record in [s]."""
    return float(wind.time[-1]) - float(wind.time[0]) if len(wind.time) else 0.0


def _steps(
    simulator: SwaySimulator, wind: WindSamples | Floats, rate: float,
    measure: Callable[[int, Floats], None],
) -> tuple[int, Iterator[None]]:  # fmt: skip
    """Return the number of steps in a wind, and an iterator over them."""
    if isinstance(wind, WindSamples):
        count = int(min(_duration(wind) * rate + 1e-6, 1e15))
        return count, _through_record(simulator, wind, rate, measure)
    return len(wind), map(Run(simulator, rate, stepped=measure).step, wind)


def _through_record(
    simulator: SwaySimulator, wind: WindSamples, rate: float,
    measure: Callable[[int, Floats], None],
) -> Iterator[None]:  # fmt: skip
    """
    Step through a record like a live wind, with all samples known in advance.

    Between samples that are means the wind is interpolated.
    """
    time, velocity = interpolated_means(wind.time, wind.velocity)
    ahead = float(np.median(np.diff(time)))
    hold = max(LONGEST_HOLD, 3.0 * ahead) + ahead
    run = Run(
        simulator, rate, intake=WindIntake(gate=WindGate(max_speed=FASTEST_WIND)),
        make_wind=lambda: WindAverage(hold), stepped=measure,
    )  # fmt: skip
    samples = _samples(time, velocity)
    following = next(samples, None)
    for step in itertools.count(1):
        end = step * run.period
        while following is not None and following[0] <= end + 1e9 * ahead:
            run.offer(*following)
            following = next(samples, None)
        run.advance(end, delay=-ahead)
        yield


def _samples(time: Floats, velocity: Floats) -> Iterator[tuple[int, Any]]:
    """Yield stamps [ns] and velocities [m/s] as plain numbers, which take ten times the memory."""
    for first in range(0, len(time), _CHUNK):
        part = slice(first, first + _CHUNK)
        stamps = np.rint(1e9 * (time[part] - time[0])).astype(np.int64)
        yield from zip(stamps.tolist(), velocity[part].tolist(), strict=True)


def _chosen(tree: Tree, branches: Sequence[int] | None) -> Ints:
    """Branches whose tips are recorded, (k,)."""
    if branches is None:
        return np.array([tree.branch_of_segment[int(np.argmax(tree.end[:, 2]))]])
    try:
        chosen = np.array([operator.index(branch) for branch in branches], dtype=np.int64)
    except (TypeError, OverflowError):
        raise ParameterError(
            f'{branches!r:.80} are not numbers of branches',
            where='branches',
            cure=f'give a list of whole numbers from 0 to {tree.n_branches - 1}',
        ) from None
    wrong = chosen[(chosen < 0) | (chosen >= tree.n_branches)]
    if len(wrong):
        raise ParameterError(
            f'branch {wrong[0]}', where='branches', cure=f'give 0 to {tree.n_branches - 1}'
        )
    return chosen
