# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A tree on the page follows a live sensor, says so, and goes on without it."""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path
import threading
import time
from typing import Any, ClassVar, NamedTuple

import numpy as np
import pytest

pytest.importorskip('aiohttp', reason='aiohttp is not installed')

from tree_sway_lab.twin.simulated_sensor import SensedMotion, SimulatedSensor  # noqa: E402

from tree_sway.commands.cli import main  # noqa: E402
from tree_sway.core.arrays import Floats  # noqa: E402
from tree_sway.core.scene.make import make_simulator  # noqa: E402
from tree_sway.core.species.species import species_named  # noqa: E402
from tree_sway.core.wind.turbulence import simulate_turbulence  # noqa: E402
from tree_sway.files.trees.source import open_tree  # noqa: E402
from tree_sway.growth.builtin import builtin_tree  # noqa: E402
from tree_sway.live import Sighting  # noqa: E402
from tree_sway.live.motion import motion_feed  # noqa: E402
from tree_sway.live.motion.live_motion import LiveMotion  # noqa: E402
from tree_sway.live.motion.motion_feed import MotionFeed, PlacedSensor  # noqa: E402
from tree_sway.live.motion.motion_reading import MotionReading  # noqa: E402
from tree_sway.live.motion.motion_registry import open_motion  # noqa: E402
from tree_sway.page.commands import show  # noqa: E402
from tree_sway.page.commands.page_controls import page_controls  # noqa: E402
from tree_sway.page.session import Choices, Session  # noqa: E402
from tree_sway.simulation.wind_source import RecordedWind, Sample  # noqa: E402
from tree_sway.twin.camera import Camera, looking  # noqa: E402
from tree_sway.twin.commands.on_the_page import SensorsOnThePage  # noqa: E402
from tree_sway.twin.observed_tree import ObservedTree  # noqa: E402
from tree_sway.twin.sensor_place import place_on  # noqa: E402
from tree_sway.twin.sensor_report import sensor_reports  # noqa: E402
from tree_sway.twin.tree_fit import TreeFit  # noqa: E402

DT, SECONDS = 1.0 / 60.0, 50
TREE = builtin_tree('goldcrest')
SEGMENT = place_on(TREE, f'{TREE.branch_names[0]}:0.7').segment
BEGAN = 5000.0
"""Time of this machine at which the session begins in [s]."""


class Truth(NamedTuple):
    """Wind (n, 3), displacement of the tip (n, 3), and what a sensor measures."""

    wind: Floats
    tips: Floats
    motion: SensedMotion


@cache
def truth() -> Truth:
    """Sway a softer tree in a wind of which the anemometer, away from it, misses a part."""
    softer = replace(species_named('goldcrest'), modulus=6.0e9)
    sim = make_simulator(TREE, softer, crown_coherence=0.3)
    rng = np.random.default_rng(31)
    wind = simulate_turbulence(4.0, rate=60.0, duration=SECONDS, rng=rng)
    missed = simulate_turbulence(4.0, rate=60.0, duration=SECONDS, rng=rng)
    there = wind + 0.7 * (missed - missed.mean(axis=0))
    tips, poses = np.empty((len(wind), 3)), np.empty((len(wind), 7))
    for k, each in enumerate(there):
        sim.step(each, DT)
        tips[k] = sim.tip_displacement
        poses[k] = sim.place()[SEGMENT]
    return Truth(wind, tips, SimulatedSensor(rate=100.0).measured(poses, DT, rng))


class Sensor:
    """The part of a live sensor that a feed reads, on a clock of its own."""

    name, problem, note = 'phone', '', ''

    def __init__(self) -> None:
        self.now = BEGAN
        motion = truth().motion
        self._left = list(zip(*motion, strict=True))
        self.ends_at = np.inf
        self.left_out = 0

    def drain(self, until: float = np.inf) -> list[MotionReading]:
        """Return what was measured until then and came up to now, 40 ms late."""
        found = []
        end = min(self.now - 0.04, until) - BEGAN
        while self._left and self._left[0][0] <= end:
            at, force, spin = self._left.pop(0)
            if at < self.ends_at:
                found.append(MotionReading(BEGAN + at, tuple(force), tuple(spin), None))
        return found


class Sink:
    """Takes what a session publishes, in place of a server."""

    def describe(self, *_: Any) -> None:
        """Take a description."""

    def publish(self, _: bytes) -> None:
        """Take a frame."""

    def __init__(self) -> None:
        self.messages: list[Any] = []

    def announce(self, message: Any, *_: Any) -> None:
        """Take a message."""
        self.messages.append(message)


@pytest.fixture
def sensor(monkeypatch: pytest.MonkeyPatch) -> Sensor:
    made = Sensor()
    monkeypatch.setattr(motion_feed.time, 'monotonic', lambda: made.now)
    return made


def show_arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser()
    show.add_arguments(parser)
    return parser.parse_args(['goldcrest'])


def added_sensors(arguments: argparse.Namespace, places: Mapping[str, str]) -> SensorsOnThePage:
    """Sensors of a page that are heard already."""
    added = SensorsOnThePage(arguments)
    added.places = places
    return added


class LateMachine:
    """What a session waits for, on the clock of a sensor; one wait of 300 is too long."""

    def __init__(self, sensor: Sensor, late: float, steps: int) -> None:
        self._sensor, self._late, self._left = sensor, late, steps

    def is_set(self) -> bool:
        """Whether all steps are taken."""
        return self._left == 0

    def wait(self, seconds: float) -> None:
        """Wait."""
        self._left -= 1
        self._sensor.now += seconds + self._late * (self._left % 300 == 150)


class StillFilm:
    """The part of a live film that a feed reads: a tree that hangs still, until pictures end."""

    name, problem, rate, refused, is_over = 'camera:0', '', 30.0, 0, False

    def __init__(self, sensor: Sensor) -> None:
        self._clock = sensor
        away = 2.0 * float(TREE.end[:, 2].max())
        axes = looking(0.0, 0.0, 0.0)
        height = 0.3 * away
        at = np.array([0.0, -away, height])
        self.camera = Camera(at, axes, 900.0, np.array([640.0, 360.0]))
        middles = 0.5 * (TREE.start + TREE.end)
        self._points = self.camera.project(middles)

    def drain(self) -> list[Sighting]:
        """Return a picture of now."""
        return [] if self.is_over else [Sighting(self._clock.now, 0, self._points)]


class SlowWind:
    """The wind of the truth at some times alone [s], of which nobody knows what is to come."""

    source: ClassVar[dict[str, object]] = {'kind': 'live'}

    def __init__(self, times: Sequence[float]) -> None:
        self._left = list(times)

    def between(self, _since: float, until: float) -> Iterator[Sample]:
        """Return the samples up to a time."""
        while self._left and self._left[0] <= until:
            x, y, z = truth().wind[round(self._left[0] * 60)].tolist()
            yield self._left.pop(0), (x, y, z)


def session_of(
    placed: list[PlacedSensor], film: StillFilm | None = None, slow: SlowWind | None = None
) -> Session:
    """Make a session with the wind of the truth."""
    wind = truth().wind
    record = RecordedWind(DT * np.arange(len(wind)), wind) if slow is None else slow
    arguments = show_arguments()
    feed = MotionFeed(placed)
    feed.film = film  # type: ignore[assignment]
    added = [added_sensors(arguments, feed.places)]
    added[0].motion = feed
    session = Session(
        lambda wanted: show.build_scene(wanted, arguments, added),
        Choices('goldcrest'),
        record,
        motion=feed,
    )
    session._server = Sink()  # type: ignore[assignment]
    return session


def swayed(
    sensor: Sensor, placed: list[PlacedSensor], until: int = SECONDS, slow: SlowWind | None = None
) -> tuple[Any, Floats]:
    """Step a session with the wind of the truth; its tip displacement at each step."""
    session = session_of(placed, slow=slow)
    tips = np.empty((until * 60, 3))
    for k in range(len(tips)):
        sensor.now += DT
        session._step(0.0)
        tips[k] = session._scene.simulator.tip_displacement  # type: ignore[union-attr]
    return session, tips


def error(tips: Floats) -> float:
    """Dynamic error over the true motion of the last 15 s, at the best of some delays."""
    found = tips[-15 * 60 :]
    errors = []
    for late in range(8):
        end = len(tips) - late
        wanted = truth().tips[end - len(found) : end]
        power = np.var(found - wanted, axis=0).sum() / np.var(wanted, axis=0).sum()
        errors.append(float(np.sqrt(power)))
    return min(errors)


def test_the_tree_follows_and_the_page_says_how(sensor: Sensor) -> None:
    _, alone = swayed(sensor, [])
    sensor.now = BEGAN
    session, tips = swayed(sensor, [PlacedSensor(sensor, f'segment:{SEGMENT}')])  # type: ignore[arg-type]
    left = error(tips) / error(alone)
    assert left < 0.5
    status = session.status()['motion']
    (told,) = status['sensors']
    assert told['name'] == f'phone at segment:{SEGMENT}'
    assert told['in_use']
    assert told['problem'] == ''
    low, high = status['band']
    assert low < 0.0 < high < 0.5
    assert told['rate'] == pytest.approx(100.0, rel=0.1)
    assert 0.1 < told['residual'] < 3.0
    assert 0.3 < status['explained'] < 0.95
    learned = session._scene.simulator.learned
    said = {key: values for key, *values in status['said']}
    assert said['sensor_followed'][0] == told['name']
    assert said['shares'][0] == f'{100.0 * status["explained"]:.0f}'
    assert said.get('learned_sway', [None])[-1] == (learned and f'{learned.hours:.2f}')
    print(f'error {error(alone):.2f} by the wind, {error(tips):.2f} with it; {status}')


def test_a_slow_anemometer_makes_no_sensor_late(sensor: Sensor) -> None:
    """What is measured is used as it comes, whatever the time to which the wind is known."""
    placed = [PlacedSensor(sensor, f'segment:{SEGMENT}')]  # type: ignore[arg-type]
    session, tips = swayed(sensor, placed, slow=SlowWind(range(0, SECONDS, 3)))
    (told,) = session.status()['motion']['sensors']
    assert told['in_use']
    assert told['refused'] == 0
    assert 'the wind is known 3.0 s late' in told['notes'][-1]
    wrong, wanted = (each[-10 * 60 :] for each in (tips - truth().tips, truth().tips))
    assert np.var(wrong, axis=0).sum() < 0.25 * np.var(wanted, axis=0).sum()


def test_a_pair_of_winds_far_apart_turns_no_clock_back(sensor: Sensor) -> None:
    placed = [PlacedSensor(sensor, f'segment:{SEGMENT}')]  # type: ignore[arg-type]
    session, _ = swayed(sensor, placed, until=12, slow=SlowWind((0, 10)))
    twin: Any = session._scene.simulator
    assert twin.now == pytest.approx(12.0)
    (known,) = twin.sensors.values()
    assert known.counts.refused == 0
    assert known.counts.accepted == pytest.approx(1200, abs=10)


def test_what_a_page_learns_is_kept_and_gone_on_with(
    sensor: Sensor, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    path = str(tmp_path / 'own.twin.yaml')
    places = {'phone': f'segment:{SEGMENT}'}
    arguments = show_arguments()
    arguments.learn, arguments.motion = path, ['udp:5006']
    for run in (1, 2):
        added = added_sensors(arguments, places)
        twin = show.build_scene(Choices('goldcrest'), arguments, [added])
        assert isinstance(twin, ObservedTree)
        fit = TreeFit(0.9, 1.2, 0.02, 0.2, 0.9, 0.2, 1.0)
        monkeypatch.setattr(twin.observer._fit, 'found', fit)
        added.note(twin)
        found = open_tree(path)
        assert found.learned is not None
        assert found.learned.hours == pytest.approx(run)
        # A tree that a viewer chooses learns nothing.
        added.note(show.build_scene(Choices('goldcrest', count='2'), arguments, [added]))
        added.tell(twin)
        assert f'own.twin.yaml: learned from {run} h of motion' in capsys.readouterr().out
    # A file that becomes impossible to write is told, and the tree goes on.
    monkeypatch.setattr(twin.observer._fit, 'found', fit._replace(hours=2.0))
    Path(path).unlink()
    tmp_path.rmdir()
    added.note(twin)
    assert 'own.twin.yaml: cannot be written' in capsys.readouterr().err


def test_the_page_says_what_a_camera_tells(sensor: Sensor) -> None:
    film = StillFilm(sensor)
    session = session_of([], film)

    def told(steps: int) -> dict[str, Any]:
        for _ in range(steps):
            sensor.now += DT
            session._step(0.0)
        status = session.status()['motion']
        assert 'explained' not in status  # it is the share that motion sensors leave
        (camera,) = status['sensors']  # type: ignore[index]
        return dict(camera)

    seen = told(60)
    assert seen['name'] == 'camera:0'
    assert seen['in_use']
    assert seen['rate'] == 30.0
    assert 'points on the tree' in seen['notes'][0]
    assert session.status()['motion']['said'][0][:2] == ['sensor_followed', 'camera:0']  # type: ignore[index]
    film.is_over = True
    lost = told(60)
    assert not lost['in_use']
    assert 'no picture' in lost['problem']


def test_a_viewer_moves_the_sensor_and_a_place_that_is_none_is_refused(sensor: Sensor) -> None:
    session, _ = swayed(sensor, [PlacedSensor(sensor, f'segment:{SEGMENT}')], until=1)  # type: ignore[arg-type]

    def choose(place: str) -> None:
        session.apply('sensor_at', place)
        end = time.monotonic_ns() + 60 * 10**9
        while session._builder.wanted is not None:
            assert time.monotonic_ns() < end
            threading.Event().wait(0.01)
        sensor.now += DT
        session._step(0.0)

    choose('segment:5')
    (told,) = session.status()['motion']['sensors']
    assert told['name'] == 'phone at segment:5'
    for _ in range(30):
        sensor.now += DT
        session._step(0.0)
    twin = session._scene.simulator
    assert next(iter(twin.sensors.values())).counts.accepted > 40  # at 100 Hz
    choose('99')
    assert 'the stem has no height' in session._server.messages[-1]['refused']['reason']
    assert session.status()['motion']['sensors'][0]['name'] == 'phone at segment:5'


def test_a_sensor_that_falls_silent_leaves_the_wind(sensor: Sensor) -> None:
    sensor.ends_at = 25.0
    session, tips = swayed(sensor, [PlacedSensor(sensor, f'segment:{SEGMENT}')], until=38)  # type: ignore[arg-type]
    (told,) = session.status()['motion']['sensors']
    assert not told['in_use']
    assert 'silent' in told['problem']
    twin = session._scene.simulator
    assert np.abs(twin._added).max() < 1e-6
    assert np.isfinite(tips).all()


@pytest.mark.parametrize(('late', 'left_out'), [(0.2, 0), (1.0, 2 * 100)])
def test_no_sample_is_refused_as_a_machine_was_late(
    sensor: Sensor, late: float, left_out: int
) -> None:
    """Those of time that the steps left out, as it was too much to catch up, have a count."""
    session = session_of([PlacedSensor(sensor, f'segment:{SEGMENT}')])  # type: ignore[arg-type]
    session._stop = LateMachine(sensor, late, 600)  # type: ignore[assignment]
    session._run()
    assert session.failure is None
    (known,) = session._scene.simulator.sensors.values()  # type: ignore[union-attr]
    assert known.counts.refused == known.counts.restarted == 0
    assert sensor.left_out == pytest.approx(left_out, abs=5)
    offered = round(100.0 * (sensor.now - BEGAN - 0.04))
    assert known.counts.accepted == pytest.approx(offered - left_out, abs=5)
    (told,) = session.status()['motion']['sensors']  # type: ignore[index]
    assert told['refused'] == sensor.left_out


def test_a_pause_does_not_move_the_clocks_apart(sensor: Sensor) -> None:
    feed = MotionFeed([])
    feed.feed(None, 10.0)
    assert feed._time_of(BEGAN) == pytest.approx(10.0)
    sensor.now += 60.0
    feed.feed(None, 10.0 + DT)
    assert feed._time_of(BEGAN - 0.1) == pytest.approx(9.9)
    assert feed._time_of(BEGAN + 30.0) is None
    assert feed._time_of(BEGAN + 60.0) == pytest.approx(10.0 + DT)


def test_it_is_told_why_samples_were_refused() -> None:
    live = LiveMotion(open_motion('udp:5006'), print)
    assert live.note == ''
    live.left_out = 3
    assert live.note.startswith('3 samples were refused: the tree stood still then')
    twin = ObservedTree(TREE, at={'phone': f'segment:{SEGMENT}'})
    for at in (0.0, 0.02, 0.01):
        twin.offer('phone', at, acceleration=(0.1 * at, 0.0, 9.8))
    (told,) = sensor_reports(twin)
    assert told.notes == ('1 samples were refused: their times do not rise',)


@pytest.mark.parametrize(
    ('extra', 'words'),
    [
        (['--motion', 'udp:5006'], '1 --motion and 0 --at'),
        (['--learn', 'own.yaml'], 'no motion sensor to learn from'),
        (['--motion', 'udp:5006', '--at', '0.2', '--learn', 'own.glb'], 'cannot store'),
        (['--motion', 'udp:5006', '--at', '0.2', '--learn', 'none/own.yaml'], 'no such folder'),
        (['--motion', 'udp:5006', '--at', '99'], 'the stem has no height'),
        (['--motion', 'udp:5006', '--at', '0.2', '--stand', '9'], 'stand of 9 trees'),
        (['--motion', 'motion.csv', '--at', '0.2'], 'does not begin with a kind of source'),
        (['--motion', 'udp:5006', '--at', '0.2'] * 2, 'two sensors at udp://:5006'),
        (
            '--motion udp:5006?name=low --at 0.1 --motion udp://:5006?name=high --at 0.2'.split(),
            'two sensors at udp://:5006; a sensor has one place',
        ),
        (
            '--motion udp:5006?name=stem --at 0.2 --motion udp:5007?name=stem --at 0.2'.split(),
            'two sensors of one name',
        ),
        (
            ['--motion', 'udp:5006', '--at', '0.2', '--model', 'auto'],
            'give a number of coordinates',
        ),
    ],
)
def test_mistakes_are_told_with_the_cure(
    extra: list[str], words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(['show', 'goldcrest', '--port', '0', '--seconds', '0', *extra]) == 2
    assert words in capsys.readouterr().err


def test_viewers_cannot_add_a_sensor() -> None:
    """No control of the page opens an address; only who starts the command does."""
    names = {each.name for each in page_controls(Choices('goldcrest'), RecordedWind(
        np.arange(3.0), np.ones((3, 3))))}  # fmt: skip
    assert not names & {'motion', 'at', 'sensor'}
