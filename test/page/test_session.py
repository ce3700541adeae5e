# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A live tree without ROS: it goes in real time, and takes changes while it runs."""

from __future__ import annotations

from collections.abc import Callable, Iterator
import itertools
from pathlib import Path
import threading
import time
from typing import Any, ClassVar

import numpy as np
import pytest

pytest.importorskip('aiohttp', reason='aiohttp is not installed')

from tree_sway_lab.kinds.kinds import kind_called  # noqa: E402
from tree_sway_lab.validation.truth import SETTINGS, WOOD  # noqa: E402

from tree_sway.core.scene.make import make_simulator  # noqa: E402
from tree_sway.core.scene.run import Run  # noqa: E402
from tree_sway.core.settings import Settings  # noqa: E402
from tree_sway.errors import FormatError, ParameterError  # noqa: E402
from tree_sway.files.trees.source import open_scene  # noqa: E402
from tree_sway.newest import Newest  # noqa: E402
from tree_sway.page.session import Choices, Session  # noqa: E402
from tree_sway.simulation import wind_source  # noqa: E402
from tree_sway.simulation.wind_source import blow, RecordedWind, Sample, SimulatedWind  # noqa: E402
from tree_sway.stream.controls import ControlPanel  # noqa: E402
from tree_sway.stream.protocol import decode_description, decode_frame, PAUSED  # noqa: E402

SEEDLING = Path(__file__).parents[1] / 'files' / 'data' / 'seedling.yaml'
DEADLINE = 30.0


class Measured:
    """A wind of which nobody knows what is to come."""

    source: ClassVar[dict[str, object]] = {'kind': 'live'}

    def between(self, since: float, until: float) -> Iterator[Sample]:
        return iter(())


class Sink:
    """Takes what a session publishes, in place of a server."""

    def __init__(self) -> None:
        self.descriptions: list[bytes] = []
        self.frames: list[bytes] = []
        self.messages: list[Any] = []

    def describe(self, description: bytes, *_: Any) -> None:
        self.descriptions.append(description)

    def publish(self, frame: bytes) -> None:
        self.frames.append(frame)

    def announce(self, content: Any, values: Any = None) -> None:
        self.messages.append(content)


def build(choices: Choices) -> Any:
    if choices.tree == 'missing':
        raise FormatError("no tree 'missing'", cure='name another')
    settings = Settings(damping_ratio=choices.damping_ratio or None)
    return open_scene(choices.tree).simulator(settings, model=choices.model)


def until(holds: Callable[[], Any]) -> None:
    end = time.monotonic() + DEADLINE
    while not holds():
        assert time.monotonic() < end, 'it did not come to pass'
        time.sleep(0.005)


@pytest.fixture
def live() -> Iterator[tuple[Session, Sink]]:
    session, sink = Session(build, Choices(str(SEEDLING)), SimulatedWind(5.0)), Sink()
    session.serve(sink)  # type: ignore[arg-type]
    yield session, sink
    session.stop()
    assert session.failure is None


def test_frames_belong_to_the_description_and_keep_time(live: tuple[Session, Sink]) -> None:
    _, sink = live
    until(lambda: len(sink.frames) > 60)
    identity = decode_description(sink.descriptions[0]).short_identity
    frames = [decode_frame(frame) for frame in sink.frames[:60]]
    assert {frame.identity for frame in frames} == {identity}
    assert [frame.sequence for frame in frames] == list(range(60))
    assert 0.5 < (frames[-1].stamp - frames[0].stamp) * 1e-9 < 10.0
    assert np.linalg.norm(frames[-1].wind) > 0.5


@pytest.mark.parametrize(('clock', 'sent'), [('perf_counter', 100), ('thread_time', 60)])
def test_work_of_its_own_alone_thins_the_frames(
    clock: str, sent: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Where other programs delay the steps, each is sent."""
    session, sink = Session(build, Choices(str(SEEDLING)), SimulatedWind(5.0)), Sink()
    session._server = sink  # type: ignore[assignment]
    passed = itertools.count()
    monkeypatch.setattr(time, 'thread_time', lambda: 0.0)
    monkeypatch.setattr(time, clock, lambda: 0.01 * next(passed))
    for _ in range(100):
        session._step(time.perf_counter())
    assert len(sink.frames) == pytest.approx(sent, abs=10)


def test_pause_and_reset(live: tuple[Session, Sink]) -> None:
    session, sink = live
    until(lambda: len(sink.frames) > 30)
    session.apply('pause', True)
    until(lambda: decode_frame(sink.frames[-1]).flags & PAUSED)
    still = decode_frame(sink.frames[-1]).coordinates
    n = len(sink.frames)
    until(lambda: len(sink.frames) > n + 5)
    assert (decode_frame(sink.frames[-1]).coordinates == still).all()
    session.apply('reset', None)
    until(lambda: not decode_frame(sink.frames[-1]).coordinates.any())


def test_another_model_is_built_beside_and_taken_over(live: tuple[Session, Sink]) -> None:
    session, sink = live
    session.apply('model', 'branch')
    until(lambda: len(sink.descriptions) == 2)
    assert session.status()['model'] == 'branch'
    identity = decode_description(sink.descriptions[1]).short_identity
    until(lambda: decode_frame(sink.frames[-1]).identity == identity)


def test_a_limp_tree_says_how_many_coordinates_it_solves() -> None:
    def build_whips(choices: Choices) -> Any:
        return make_simulator(kind_called(choices.tree), WOOD, SETTINGS, model=200)

    session = Session(build_whips, Choices('whips'), SimulatedWind(5.0))
    solved = len(session.simulator.models[0].stiffness)
    assert 0 < solved < 200
    assert session.status()['model'] == f'{solved}/200'


def test_what_cannot_be_built_is_reported_and_the_old_goes_on(live: tuple[Session, Sink]) -> None:
    session, sink = live
    session.apply('tree', 'missing')
    until(lambda: sink.messages)
    assert "no tree 'missing'" in sink.messages[0]['refused']['reason']
    n = len(sink.frames)
    until(lambda: len(sink.frames) > n + 5)
    assert session.choices.tree == str(SEEDLING)
    with pytest.raises(ParameterError, match='cannot be changed'):
        session.apply('gravity', 0.0)


@pytest.mark.parametrize(('tree', 'age'), [('willow', 0.0), ('cherry', 57.0), ('lime', 120.0)])
def test_a_tree_of_another_species_has_an_age_that_was_measured(tree: str, age: float) -> None:
    wanted: list[Choices] = []
    session = Session(build, Choices(str(SEEDLING)), SimulatedWind(5.0))
    session._builder.want = wanted.append  # type: ignore[method-assign]
    session.choices = Choices('oak', age=120.0)
    session.apply('tree', tree)
    assert (wanted[0].tree, wanted[0].age) == (tree, age)


def test_a_fault_while_building_is_reported_and_the_next_wish_is_built(
    live: tuple[Session, Sink], caplog: pytest.LogCaptureFixture
) -> None:
    session, sink = live

    def fail(_: Choices) -> Any:
        raise ZeroDivisionError('a fault of the program')

    session._build = fail
    session.apply('tree', 'oak')
    until(lambda: sink.messages)
    assert (
        'oak cannot be built (ZeroDivisionError: a fault' in sink.messages[0]['refused']['reason']
    )
    assert 'ZeroDivisionError' in caplog.text
    until(lambda: not session.status()['building'])
    session._build = build
    session.apply('tree', str(SEEDLING))
    until(lambda: len(sink.descriptions) == 2)


def test_the_wind_changes_at_once_and_a_record_does_not(live: tuple[Session, Sink]) -> None:
    session, _ = live
    ((_, before),) = session.wind.between(10.0, 10.05)
    session.apply('mean_speed', 10.0)
    until(lambda: [sample for _, sample in session.wind.between(10.0, 10.05)] != [before])
    ((_, after),) = session.wind.between(10.0, 10.05)  # the same gusts about another mean
    assert 1.5 < np.linalg.norm(after) / np.linalg.norm(before) < 2.5
    session.wind = RecordedWind(np.array([0.0, 1.0]), np.array([[1.0, 0, 0], [3.0, 0, 0]]))
    samples = list(session.wind.between(-1.0, 5.0))
    assert [time for time, _ in samples] == [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]
    assert [x for _, (x, _, _) in samples] == [1.0, 3.0] * 3
    cut = [*session.wind.between(-1.0, 2.5), *session.wind.between(2.5, 5.0)]
    assert cut == samples
    with pytest.raises(ParameterError, match='record'):
        session.apply('mean_speed', 3.0)


def test_a_run_that_begins_late_is_given_the_last_samples_alone() -> None:
    class Counted(SimulatedWind):
        n_samples = 0

        def between(self, since: float, until: float) -> Iterator[Any]:
            for sample in super().between(since, until):
                self.n_samples += 1
                yield sample

    run, wind = Run(open_scene(str(SEEDLING)).simulator()), Counted(8.0)
    week = 7 * 24 * 3600 * 10**9 // run.period * run.period
    blow(run, wind, week)
    assert run.simulator.wind[0] > 2.0  # it blows from the first step on
    assert 0 < wind.n_samples <= 200
    blow(run, wind, week + run.period)
    assert wind.n_samples <= 201


def test_turbulence_is_made_on_another_thread_and_the_newest_alone(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    may_go_on, made = threading.Event(), list[tuple[int, float]]()
    own = wind_source.AnemometerModel

    def slow(mean_speed: float, **others: Any) -> Any:
        made.append((threading.get_ident(), mean_speed))
        may_go_on.wait(DEADLINE)
        return own(mean_speed, **others)

    wind = SimulatedWind(5.0)
    monkeypatch.setattr(wind_source, 'AnemometerModel', slow)
    for speed in np.linspace(6.0, 12.0, 50).tolist():
        wind.set('mean_speed', speed)
    ((_, calm),) = wind.between(10.0, 10.05)  # the old one goes on
    may_go_on.set()
    until(lambda: [sample for _, sample in wind.between(10.0, 10.05)] != [calm])
    until(lambda: wind._maker.wanted is None)
    assert threading.get_ident() not in {thread for thread, _ in made}
    assert [speed for _, speed in made] in ([6.0, 12.0], [12.0])
    ((_, strong),) = wind.between(10.0, 10.05)
    assert np.linalg.norm(strong) > 2.0 * np.linalg.norm(calm)


def test_no_request_is_lost_between_two() -> None:
    done = list[int]()
    newest = Newest(done.append, 'test')
    for number in range(1, 3000):
        newest.want(number)
    until(lambda: newest.wanted is None)
    assert done[-1] == 2999
    assert done == sorted(set(done))


def test_a_record_goes_on_from_any_of_its_times(live: tuple[Session, Sink]) -> None:
    session, _ = live
    wind = RecordedWind(np.arange(10.0), np.outer(np.arange(10.0), [1.0, 0.0, 0.0]))
    wind.seek(4.0, now=100.0)
    assert list(wind.between(100.5, 102.0)) == [(101.0, (5, 0, 0)), (102.0, (6, 0, 0))]
    assert wind.time(107.0) == pytest.approx(1.0)  # from its beginning after its end
    assert 'record_time' not in session.status()
    session.wind = wind
    session.apply('record_time', 7.0)
    assert session.status()['record_time'] == pytest.approx(7.0, abs=0.2)


@pytest.mark.parametrize('to', [0.0, 90.0])
def test_a_seek_while_samples_are_taken_leaves_none_outside_their_time(to: float) -> None:
    wind = RecordedWind(np.arange(0.0, 100.0, 0.1), np.ones((1000, 3)))
    wind.seek(50.0, now=100.0)
    samples = wind.between(100.0, 101.0)
    times = [next(samples)[0]]
    wind.seek(to, now=100.0)
    times += [time for time, _ in samples]
    np.testing.assert_allclose(times, np.arange(100.1, 101.05, 0.1))


def test_viewers_are_told_of_gusts_to_come_that_are_known(live: tuple[Session, Sink]) -> None:
    session, _ = live
    session.wind = RecordedWind(np.arange(20.0), np.outer(np.arange(20.0), [0.6, 0.8, 0.0]))
    session.apply('record_time', 2.0)
    ahead: Any = session.status()['wind_ahead']
    speeds = np.interp(np.arange(len(ahead['speeds'])) * ahead['every'], np.arange(20), range(20))
    assert len(speeds) >= 10
    np.testing.assert_allclose(ahead['speeds'], 2.0 + speeds, atol=1.3)  # samples a second apart
    session.wind = SimulatedWind(5.0, intensity=0.0)
    assert set(session.status()['wind_ahead']['speeds']) == {5.0}  # type: ignore[index]
    session.wind = Measured()
    assert 'wind_ahead' not in session.status()


def test_damping_and_wind_are_those_in_use(live: tuple[Session, Sink]) -> None:
    session, sink = live
    own = session.values()['damping_ratio']
    assert own == session._scene.kinds[0].simulator.models[0].damping_ratio > 0.0
    assert session.choices.damping_ratio == 0.0
    session.apply('damping_ratio', 0.25)
    until(lambda: len(sink.descriptions) == 2)
    assert session.values()['damping_ratio'] == 0.25
    session.apply('damping_ratio', 0.0)  # back to that of the species
    until(lambda: len(sink.descriptions) == 3)
    assert session.values()['damping_ratio'] == own
    assert session.status()['wind'] == {'kind': 'simulated'}
    session.wind = RecordedWind(np.array([0.0, 1.0]), np.ones((2, 3)), 'canopy')
    assert session.status()['wind'] == {'kind': 'recorded', 'name': 'canopy'}


def test_what_is_shown_is_written_as_a_file(live: tuple[Session, Sink]) -> None:
    session, _ = live
    assert session.written('glb')[:4] == b'glTF'
    assert b'id="scene"' in session.written('html')


@pytest.mark.parametrize(
    'pull',
    [
        {'segment': True, 'to': [1.0, 0.0, 1.0], 'stiffness': 5.0},
        {'segment': 0.0, 'to': [1.0, 0.0, 1.0], 'stiffness': 5.0},
        {'segment': 0, 'to': [True, 0.0, 1.0], 'stiffness': 5.0},
        {'segment': 0, 'to': ['1', 0.0, 1.0], 'stiffness': 5.0},
        {'segment': 0, 'to': [1.0, 0.0, 1.0], 'stiffness': '5'},
        {'segment': 0, 'to': [1.0, 0.0, 1.0], 'stiffness': None},
        {'segment': 0, 'to': [1.0, 0.0, 1e6], 'stiffness': 5.0},
        {'segment': 10**30, 'to': [1.0, 0.0, 1.0], 'stiffness': 5.0},
        {'segment': 0, 'to': [1.0, 0.0, 1.0], 'stiffness': 1e-300},
        {'segment': 0, 'to': [1e5, 1e5, 1e5], 'stiffness': 1e7},
        {'segment': 0, 'to': [1.0, 0.0, 1.0], 'stiffness': 5.0},
        {'segment': -1, 'to': [1.0, 0.0, 1.0], 'stiffness': 5.0},
    ],
)
def test_no_pull_ends_the_session(pull: Any, live: tuple[Session, Sink]) -> None:
    session, sink = live
    reasons: list[str] = []
    refused = ControlPanel(pull=session.pull).pull(pull, reasons.append)
    n = len(sink.frames)
    until(lambda: len(sink.frames) > n + 10 or session.failure)
    assert session.failure is None
    assert not sink.messages  # others hear nothing of it
    is_possible = pull['segment'] == 0 and all(type(x) is float for x in pull['to'])
    is_possible &= type(pull['segment']) is int and type(pull['stiffness']) is float
    is_possible &= max(abs(float(x)) for x in pull['to']) <= 1e5
    assert (refused is None and not reasons) == is_possible


def test_a_record_that_breaks_off_is_held_and_fades_on_the_page_too() -> None:
    time_of = np.concatenate([np.arange(0.0, 2.0, 0.05), [30.0]])
    wind = RecordedWind(time_of, np.tile([8.0, 0.0, 0.0], (len(time_of), 1)))
    run, felt = Run(open_scene(str(SEEDLING)).simulator()), []
    for tick in range(1, 60 * 29):
        blow(run, wind, tick * run.period)
        felt.append(run.simulator.wind[0])
    assert felt[60 * 3] == pytest.approx(8.0)
    assert 0.0 < felt[-1] < 0.1
    assert np.abs(np.diff(felt[10:])).max() < 0.5


def test_the_page_is_told_what_was_changed_in_its_tree() -> None:
    told = {'seedling': ('changed, as bare it could carry 50 %',)}
    session = Session(
        lambda _: open_scene(SEEDLING).simulator(model=4), Choices('seedling', model='4'),
        Measured(), warnings=told,
    )  # fmt: skip
    assert session.status()['warnings'] == ['changed, as bare it could carry 50 %']
