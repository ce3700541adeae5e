# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A live tree without ROS: a thread steps it in real time and publishes each state.

Slow requests of viewers (a different tree or model) are built on a second thread, while the first
continues, and exchanged between two steps.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
import logging
import threading
import time
from typing import Any

from tree_sway.core.scene import Run, SceneSimulator, Simulator
from tree_sway.core.settings import Settings
from tree_sway.core.species import species_keys
from tree_sway.core.wind import FASTEST_WIND, WindGate, WindIntake
from tree_sway.errors import ParameterError, TreeSwayError
from tree_sway.fidelity import set_demand
from tree_sway.files.export import morphing_tree
from tree_sway.growth import BUILTIN_TREES, stem_growth
from tree_sway.live import LiveWind, MotionFeed
from tree_sway.newest import Newest
from tree_sway.page.leaf_calendar import HALF_YEAR, SUMMER
from tree_sway.page.one_file import page_of_scene
from tree_sway.page.sensors_told import sensors_told
from tree_sway.page.server import PageServer
from tree_sway.page.wind_ahead import wind_ahead
from tree_sway.simulation import blow, RecordedWind, SimulatedWind, WindSource
from tree_sway.stream import Json, Refused, SceneState, Value
from tree_sway.twin import ObservedTree, sensor_reports
from tree_sway.twin.camera import FilmedTree

_LOGGER = logging.getLogger('tree_sway.page')
RATE = 60.0
"""Steps per second in [Hz]."""

_PERIOD = 1.0 / RATE
_TOLERANCE = 0.005
"""Largest error that the model ``auto`` allows at first in [m]."""

_MOST_LATE = 0.25
"""Delay [s] that steps catch up at most."""
_NEWEST = 0.05
"""Weight of the newest step in the means of the status."""
_BUSY = 0.2
"""
Share of a period of work above which only every second step is sent. It is time of the processor:
where other programs delay a step, sending fewer of them saves nothing.
"""
_BAND_EVERY = 15
"""Steps from one estimate of the uncertainty band to the next."""


@dataclass(frozen=True)
class Choices:
    """
    Choices of the simulator: a change of one makes a new simulator.

    Parameters
    ----------
    tree
        Name or file of the tree.
    count
        Number of trees in the stand, a whole number as text.
    model
        Model of the tree.
    damping_ratio
        Damping ratio of every mode; 0 for the species' own.
    height
        Height of a tree that is grown in [m].
    age
        Age of a tree that is grown in [years]; 0 for the stem that is usual for the height.
    individual
        Which of the trees of that species and height, a whole number as text.
    month
        Time of the year of a tree that is grown, in months from 1: `leaf_share`.
    is_south
        Whether that tree stands south of the equator, half a year ahead.
    sensor_at
        Place of the motion sensor on the tree, as `place_on` takes it; as it began if empty.
    gusts, anemometer_distance
        As in `Settings`: which gusts a tree meets, and how far its anemometer stands in [m].

    """

    tree: str
    count: str = '1'
    model: str = str(Settings().model)
    damping_ratio: float = 0.0
    height: float = 12.0
    age: float = 0.0
    individual: str = '0'
    month: float = SUMMER
    is_south: bool = False
    sensor_at: str = ''
    gusts: str = 'sample'
    anemometer_distance: float = 0.0

    @property
    def northern_month(self) -> float:
        """Month in which trees of the north are as this one is."""
        return (self.month + HALF_YEAR * self.is_south - 1.0) % 12.0 + 1.0

    @property
    def is_grown(self) -> bool:
        """Whether the tree is a species to grow, neither built in nor a file."""
        return self.tree in species_keys() and self.tree not in BUILTIN_TREES

    @property
    def stem_of(self) -> str:
        """The species whose stem a tree of an age is grown with; empty if none was measured."""
        curve = stem_growth().get(self.tree) if self.is_grown else None
        return curve.measured if curve else ''

    @property
    def of_known_age(self) -> Choices:
        """The same with an age to which stems of the species were measured; 0 if none were."""
        curve = stem_growth().get(self.tree) if self.is_grown else None
        return replace(self, age=min(self.age, float(curve.oldest)) if curve else 0.0)


_Build = Callable[[Choices], Simulator]
"""Function that makes the simulator of some choices."""

_LEAVES = 1000
"""Clusters of leaves of each kind of tree."""


class Session:
    """
    A scene stepped in real time, with changes while it runs.

    Parameters
    ----------
    build
        Function that makes the simulator.
    choices
        Initial choices.
    wind
        Source of the wind.
    motion
        Live sensors, which an observed tree follows.
    warnings
        What was changed in the trees that are made, and is odd about them, by ``choices.tree``.

    Raises
    ------
    TreeSwayError
        Errors of `build`.

    """

    def __init__(
        self,
        build: _Build,
        choices: Choices,
        wind: WindSource,
        *,
        motion: MotionFeed | None = None,
        warnings: Mapping[str, Sequence[str]] | None = None,
    ) -> None:
        self._warnings = {} if warnings is None else warnings
        self._motion = MotionFeed() if motion is None else motion
        self._build = build
        self.wind = wind
        self.choices = choices
        self._tolerance = _TOLERANCE
        self._scene, self._runtime = self._made(choices)
        self._next: tuple[SceneState, Run] | None = None
        self._server: PageServer | None = None
        self._stop = threading.Event()
        self._is_paused = self._resets = False
        self._ticks = 0
        self._steps = 0
        self._band: list[float] | None = None
        self._work = 0.0
        self._spacing = _PERIOD
        self._last = time.perf_counter()
        self._builder = Newest(self._build_wanted, 'builder')
        self._thread = threading.Thread(target=self._run, name='session', daemon=True)
        self.failure: Exception | None = None

    def serve(self, server: PageServer) -> None:
        """Publish on a server from now on; the first call starts the steps."""
        server.describe(self._scene.description, self._scene.tables, self._scene.gusts)
        self._server = server
        if not self._thread.is_alive():
            self._thread.start()

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the trees."""
        return self._scene.names

    @property
    def simulator(self) -> Simulator:
        """Simulator that is stepped now."""
        return self._scene.simulator

    def wait(self, seconds: float) -> None:
        """Wait some seconds [s], or until the session has failed."""
        self._thread.join(max(0.0, seconds))

    def stop(self) -> None:
        """Stop stepping; may be called twice."""
        self._stop.set()
        if self._thread.is_alive():
            self._thread.join(timeout=5.0)

    def apply(self, name: str, value: Value) -> None:
        """
        Apply a change of a viewer.

        Raises
        ------
        ParameterError
            An unknown change, or one that is not possible now.

        """
        if name == 'pause':
            self._is_paused = bool(value)
        elif name == 'reset':
            self._resets = True
        elif name == 'tolerance':
            self._tolerance = float(value or 0.0)
            set_demand(self._scene.simulator.simulators, tolerance=self._tolerance)
        elif name == 'bearing_to' and isinstance(self.wind, LiveWind):
            self.wind.bearing_to = float(value or 0.0)
        elif name in ('mean_speed', 'intensity', 'bearing_to'):
            if not isinstance(self.wind, SimulatedWind):
                raise ParameterError(
                    f'the wind is {self.wind.source["kind"]}',
                    where=name,
                    cure='start without --wind or --sensor',
                )
            self.wind.set(name, float(value or 0.0))
        elif name == 'record_time' and isinstance(self.wind, RecordedWind):
            self.wind.seek(float(value or 0.0), self._now)
        elif name in Choices.__dataclass_fields__:
            changed = {name: value}
            before = self._builder.wanted or self.choices
            wanted = replace(before, **changed)  # type: ignore[arg-type]
            self._builder.want(wanted.of_known_age if name == 'tree' else wanted)
        else:
            raise ParameterError(f"'{name}' cannot be changed", where='page')

    def pull(
        self, segment: int, to: tuple[float, ...], stiffness: float, refused: Refused
    ) -> None:
        """Pull at a segment by a spring to a place, as `Run.pull`."""
        self._runtime.pull(segment, to, stiffness, refused)

    def values(self) -> dict[str, Value]:
        """Return the choices as they are shown: the damping ratio in use, not 0 for the usual."""
        damping = self._scene.kinds[0].simulator.models[0].damping_ratio
        return {**vars(self.choices), 'damping_ratio': damping}

    def status(self) -> Json:
        """Return the status on the page."""
        simulator = self._scene.simulator
        status = {
            'model': simulator.model,
            'rate': round(1.0 / max(self._spacing, 1e-6), 1),
            'work_us': round(1e6 * self._work, 1),
            'trees': len(self._scene.names),
            'wind': self.wind.source,
            'is_grown': self.choices.is_grown,
            'stem_of': self.choices.stem_of,
            'building': self._builder.wanted is not None,
            'warnings': list(self._warnings.get(self.choices.tree, ())),
        }
        if isinstance(self.wind, RecordedWind):
            status['record_time'] = self.wind.time(self._now)
        if isinstance(self.wind, (RecordedWind, SimulatedWind)):
            status['wind_ahead'] = wind_ahead(self.wind, self._now)
        if self._motion.sensors or self._motion.film:
            status['motion'] = self._motion_status(simulator)
        return status

    def _motion_status(self, simulator: Simulator) -> Json:
        """Return what the sensors tell; of a tree without them, that they are not in use."""
        if not isinstance(simulator, ObservedTree):
            return {'sensors': [], 'said': list(sensors_told([]))}
        live = {name: each.live for name, each in self._motion.sensors.items()}
        sensors = [
            {
                'name': f'{live[each.name].name} at {simulator.at[each.name]}',
                'in_use': each.in_use,
                'problem': live[each.name].problem or each.problem,
                'residual': round(each.residual, 2),
                'rate': round(each.rate, 1),
                'refused': each.refused + live[each.name].left_out,
                'notes': [*each.notes, *filter(None, [live[each.name].note])],
            }
            for each in sensor_reports(simulator)
        ]
        film = self._motion.film
        if film is not None and isinstance(simulator, FilmedTree):
            said, sees = simulator.said, simulator.sees
            sensors.append(
                {
                    'name': film.name,
                    'in_use': sees,
                    'problem': film.problem or ('' if sees else said),
                    'residual': round(simulator.error, 2),
                    'rate': round(film.rate, 1),
                    'refused': simulator.refused + film.refused,
                    'notes': [said],
                }
            )
        told: dict[str, Any] = {}
        if simulator.sensors:
            told['explained'] = round(simulator.explained, 3)
        if self._band is not None:
            told['band'] = self._band
        change = max(simulator.sway_changes, key=lambda each: each.size, default=None)
        sentences = sensors_told(sensors, **told, learned=simulator.learned, change=change)
        return {'sensors': sensors, **told, 'said': list(sentences)}

    def written(self, suffix: str) -> bytes:
        """
        Write the scene as a file, ``glb`` or ``html``.

        Raises
        ------
        TreeSwayError
            A stand as glTF, a model without a table as a page.

        """
        if suffix == 'html':  # such a page has one wind for each tree
            return page_of_scene(self._build(replace(self.choices, gusts='measured'))).encode()
        simulator = self._build(self.choices)
        if isinstance(simulator, SceneSimulator):
            raise ParameterError('a stand as glTF', where='page', cure='take .html')
        return morphing_tree(simulator, SceneState(simulator, _LEAVES).leaves[0]).glb()

    @property
    def _now(self) -> float:
        """Time of the run [s]."""
        return 1e-9 * self._ticks * self._runtime.period

    def _made(self, choices: Choices) -> tuple[SceneState, Run]:
        simulator = self._build(choices)
        scene = SceneState(simulator, _LEAVES)
        set_demand(simulator.simulators, tolerance=self._tolerance)
        simulator.reset()

        def begin(end: float, late: float) -> None:
            if isinstance(simulator, ObservedTree):
                simulator.set_time(end)
                simulator.late_wind.known_late = late
                simulator.late_wind.is_silent = run.is_wind_silent

        intake = WindIntake(gate=WindGate(max_speed=FASTEST_WIND))
        run = Run(simulator, RATE, intake=intake, starting=begin)
        return scene, run

    def _build_wanted(self, wanted: Choices) -> None:
        """Build what is requested; viewers get the reason of a refusal or a failure."""
        try:
            made = self._made(wanted)
            # First, as the next step takes what is made and announces the choices.
            self.choices = wanted
            self._next = made
            return
        except TreeSwayError as error:
            reason = str(error)
        except Exception as error:
            _LOGGER.exception('%s cannot be built', wanted)
            reason = f'{wanted.tree} cannot be built ({type(error).__name__}: {error})'[:400]
        if self._server is not None:
            self._server.announce({'refused': {'name': '', 'reason': reason}}, self.values())

    def _run(self) -> None:
        try:
            self._last = time.perf_counter()
            due = time.monotonic()
            while not self._stop.is_set():
                now = time.monotonic()
                due = now if now - due > _MOST_LATE else due
                self._step(time.perf_counter(), due)
                due += _PERIOD
                self._stop.wait(max(0.0, due - time.monotonic()))
        except Exception as error:
            self.failure = error

    def _note_band(self) -> None:
        """Find how sure the motion of the highest tip is [m], now and then."""
        simulator = self._scene.simulator
        if not isinstance(simulator, ObservedTree) or simulator.members is None:
            self._band = None
        elif self._ticks % _BAND_EVERY == 0:
            self._band = [round(each, 4) for each in simulator.sway_band().tolist()]

    def _step(self, begin: float, due: float | None = None) -> None:
        assert self._server is not None
        worked = time.thread_time()
        has_restarted = self._resets
        self._resets = False
        if self._next is not None:
            (self._scene, self._runtime), self._next = self._next, None
            self._server.describe(self._scene.description, self._scene.tables, self._scene.gusts)
            self._server.announce({}, self.values())
        if has_restarted:
            self._scene.simulator.reset()
        if not self._is_paused:
            self._ticks += 1
            self._motion.feed(self._scene.simulator, self._now, due)
            blow(self._runtime, self.wind, self._ticks * self._runtime.period)
            self._note_band()
        self._steps += 1
        if has_restarted or self._steps % 2 == 0 or self._work < _BUSY * _PERIOD:
            frame = self._scene.frame(
                time.time_ns(),
                is_paused=self._is_paused,
                has_restarted=has_restarted,
                is_wind_lost=self._runtime.is_wind_lost,
            )
            self._server.publish(frame)
        self._work += _NEWEST * (time.thread_time() - worked - self._work)
        self._spacing += _NEWEST * (begin - self._last - self._spacing)
        self._last = begin
