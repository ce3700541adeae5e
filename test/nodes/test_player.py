# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import dataclasses
from datetime import datetime
import subprocess
import sys

import numpy as np
import pytest

pytest.importorskip('rclpy', reason='ROS 2 is not installed')
pytestmark = pytest.mark.ros

from geometry_msgs.msg import Vector3Stamped  # noqa: E402, I100
from rclpy.qos import DurabilityPolicy, QoSProfile  # noqa: E402

from tree_sway.errors import TreeSwayError  # noqa: E402
from tree_sway.files.wind.wind_file import read_wind  # noqa: E402
from tree_sway_ros.process.topics import (  # noqa: E402
    CLOCK,
    SEGMENT_POSES,
    WIND,
    WIND_FILTERED,
)
from tree_sway_ros.reports.diagnostics import WARN  # noqa: E402
from tree_sway_ros.timing.playback import LONGEST_CLOCK_STEP  # noqa: E402
from tree_sway_ros.wire.cdr import poses_of as poses_in  # noqa: E402
from tree_sway_ros.wire.cdr import stamp_of  # noqa: E402
from tree_sway_ros.wire.wind_messages import stamp_to_ns  # noqa: E402


@pytest.fixture
def wind_file(tmp_path):
    return gusty(tmp_path)


def gusty(tmp_path, count=80):
    """Write samples of a gusty westerly at 20 Hz: four seconds of it."""
    time = np.arange(count) * 0.05
    wind = 6.0 + 2.0 * np.sin(2.0 * time) + 0.3 * np.cos(9.0 * time)
    path = tmp_path / 'wind.csv'
    rows = [f'{t:.2f},{u:.4f},{0.2 * np.sin(t):.4f},0.0' for t, u in zip(time, wind, strict=True)]
    path.write_text('time,u,v,w\n' + '\n'.join(rows) + '\n')
    return str(path)


def test_a_record_is_played_as_it_is_and_then_ends(compose, observer, wind_file):
    said = observer.listen(WIND, depth=80)
    nodes = compose(player={'file': wind_file, 'rate': 20.0, 'loop': False})
    observer.until(lambda: nodes.is_done, 'the end')
    record = read_wind(wind_file)
    observer.until(lambda: len(said) >= 78, 'the samples')
    known = {tuple(v) for v in record.velocity}
    assert all((m.vector.x, m.vector.y, m.vector.z) in known for m in said)
    periods = np.diff([stamp_to_ns(m.header.stamp) for m in said])
    np.testing.assert_allclose(np.median(periods), 0.05 / 20.0 * 1e9, rtol=1e-3)


def test_the_clock_goes_on_over_the_seam_of_a_loop(compose, observer, wind_file):
    said, ticks = observer.listen(WIND, depth=400), observer.listen(CLOCK)
    compose(player={'file': wind_file, 'rate': 40.0, 'publish_clock': True})
    observer.until(lambda: len(said) > 200, 'two rounds and a half')
    clock = [stamp_to_ns(tick.clock) for tick in ticks]
    stamps = [stamp_to_ns(m.header.stamp) for m in said]
    assert (np.diff(clock) >= 0).all()  # it does not advance until the player begins
    assert (np.diff(stamps) > 0).all()
    assert np.median(np.diff(stamps)) == pytest.approx(5e7, abs=2)
    assert stamps[0] >= 10**9


def poses_of(compose, observer, wind_file, tree_file, rate):
    """Return what a whole record moves a tree to, by the stamp of the frame in [ns]."""
    frames = observer.listen(SEGMENT_POSES, depth=1000)
    simulated = {'use_sim_time': True}
    nodes = compose(
        solver={'tree': tree_file, 'wind_delay': 2.0, **simulated},
        wind=simulated,
        player={'file': wind_file, 'publish_clock': True, 'loop': False, 'rate': rate},
    )
    observer.until(lambda: nodes.is_done, 'the end of the record', deadline=60.0)
    nodes.close()
    return {
        stamp_to_ns(frame.header.stamp): [
            (pose.position.x, pose.position.y, pose.orientation.w) for pose in frame.poses
        ]
        for frame in frames
    }


def test_replays_are_the_same_bit_for_bit_whatever_the_machine_does_beside(
    compose, observer, wind_file, tree_file
):
    """Samples that arrive within `wind_delay` act at their own times."""
    known = poses_of(compose, observer, wind_file, tree_file, 1.0)
    assert max(poses[2][0] for poses in known.values()) > 1e-3
    for rate in (1.0, 4.0):
        compared = 0
        for _ in range(6):  # beside three nodes the observer hears not every frame
            found = poses_of(compose, observer, wind_file, tree_file, rate)
            both = [stamp for stamp in sorted({*known} & {*found}) if stamp > 10**9]
            assert [stamp for stamp in both if found[stamp] != known[stamp]] == []
            compared += len(both)
            known |= found
            if compared > 60:
                break
        assert compared > 60


@pytest.fixture
def busy_core():
    """Start a process that computes all the time."""
    busy = subprocess.Popen([sys.executable, '-c', 'while True: pass'])
    yield
    busy.kill()
    busy.wait()


@pytest.mark.parametrize('rate', [pytest.param(2, marks=pytest.mark.long), 5])
@pytest.mark.usefixtures('busy_core')
def test_fast_replays_of_processes_are_the_same_and_say_what_they_are(
    run, observer, statuses, tmp_path, tree_file, rate
):
    """Two runs of the nodes as they are launched, each in a process of its own."""
    wind = gusty(tmp_path, count=140)
    last = 10**9 + 69 * 10**8
    frames, known = observer.listen(SEGMENT_POSES, raw=True, depth=2000), None

    def are_ready():
        topics = (WIND, WIND_FILTERED)
        return [observer.node.count_subscribers(each.name) for each in topics] == [1, 1]

    def is_told():
        status = statuses('solver: wind')
        measured = {pair.key: pair.value for pair in status.values}['replay rate']
        is_near = float(measured) == pytest.approx(rate, rel=0.2)
        return is_near and status.message.startswith('replay at ')

    for _ in range(2):
        frames.clear()
        simulated = 'use_sim_time:=true'
        solver = run('solver', f'tree:={tree_file}', 'wind_delay:=1.0', simulated)
        filtering = run('wind', simulated)
        observer.until(are_ready, 'the nodes')
        record = (f'file:={wind}', 'publish_clock:=true', 'loop:=false', f'rate:={rate}.0')
        player = run('player', *record)
        observer.until(lambda: frames and stamp_of(frames[-1]) > last, 'the end of the record')
        observer.until(is_told, 'the rate')
        counts = {pair.key: pair.value for pair in statuses('wind: wind').values}
        found = {stamp_of(data): poses_in(data).tobytes() for data in list(frames)}
        for process in (player, filtering, solver):
            process.terminate()
            process.wait()
        stamps = ('future_stamp', 'old_stamp', 'out_of_order', 'lost', 'refused')
        assert {counts[name] for name in stamps} == {'0'}
        known = found if known is None else known
    both = [stamp for stamp in sorted({*known} & {*found}) if 10**9 < stamp < last]
    assert len(both) > 150
    assert np.ptp([np.frombuffer(known[stamp])[14] for stamp in both]) > 1e-3
    assert [stamp for stamp in both if found[stamp] != known[stamp]] == []


def test_nothing_begins_before_a_subscriber_is_there_nor_does_the_clock(
    compose, observer, wind_file
):
    ticks = observer.listen(CLOCK)
    nodes = compose(player={'file': wind_file, 'publish_clock': True, 'rate': 20.0})
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    observer.node.create_subscription(Vector3Stamped, WIND.name, print, latched)  # hears nothing
    observer.until(lambda: len(ticks) > 10, 'a clock that stops')
    assert len({stamp_to_ns(tick.clock) for tick in ticks}) == 1
    assert nodes['player']._playback.progress()['samples'] == 0.0
    said = observer.listen(WIND)
    observer.until(lambda: said, 'wind')
    assert stamp_to_ns(said[0].header.stamp) == 10**9


def test_a_replay_waits_for_a_solver_that_takes_its_time(
    compose, observer, statuses, wind_file, tree_file
):
    """And has the same frames each time that it is played, however late the solver is."""
    frames, runs = observer.listen(SEGMENT_POSES, raw=True, depth=1000), []
    simulated, name = {'use_sim_time': True}, 'player: playback'
    for autostart in (True, False):
        frames.clear()
        record = {'file': wind_file, 'publish_clock': True, 'loop': False}
        nodes = compose(player=record, wind=simulated)

        def is_waiting():
            status = statuses(name)
            return status is not None and status.level[0] == WARN

        observer.until(is_waiting, 'a warning')
        observer.until(lambda: 'wind/filtered (0 of 1)' in statuses(name).message, 'the reason')
        # Samples that come within the delay act at their own times, also on a busy machine.
        own = {'tree': tree_file, 'autostart': autostart, 'wind_delay': 1.0}
        solver = nodes.add('solver', {**own, **simulated})
        if not autostart:
            solver.trigger_configure()
            observer.until(is_waiting, 'a warning')
            assert nodes['player']._playback.progress()['samples'] == 0.0
            solver.trigger_activate()
        player = nodes['player']
        observer.until(lambda player=player: player.is_done, 'the end')
        nodes.close()
        assert 'waiting' not in statuses(name).message
        runs.append({stamp_of(data): poses_in(data).tobytes() for data in list(frames)})
    first, second = runs
    both = [stamp for stamp in first if stamp in second]
    assert len(both) > 60
    assert [stamp for stamp in both if first[stamp] != second[stamp]] == []


@pytest.mark.parametrize('rate', [1.0, 1000.0])
def test_the_clock_goes_in_steps_that_nodes_follow(compose, observer, wind_file, rate):
    ticks = observer.listen(CLOCK, depth=100)
    observer.listen(WIND)
    compose(player={'file': wind_file, 'publish_clock': True, 'rate': rate})
    observer.until(lambda: len(ticks) > 100 and ticks[-1] != ticks[0], 'a clock that goes on')
    clock = np.array([stamp_to_ns(tick.clock) for tick in ticks])
    least = np.diff(clock)[np.diff(clock) > 0].min()
    assert least <= round(1e9 * LONGEST_CLOCK_STEP)


def test_it_reports_how_far_it_is(compose, observer, statuses, wind_file):
    observer.listen(WIND)
    nodes = compose(player={'file': wind_file})
    name = 'player: playback'
    observer.until(lambda: statuses(name) is not None, 'diagnostics')
    assert {pair.key for pair in statuses(name).values} >= {'position [s]', 'samples'}
    assert nodes['player'].get_clock() is not None


def test_a_bag_of_the_graph_itself_plays_back(compose, observer, tmp_path, monkeypatch):
    """Which holds the wind twice, as measured and as filtered."""
    from tree_sway_ros.nodes import player

    asked = {}
    monkeypatch.setattr(
        player,
        'read_wind',
        lambda path, **options: asked.update(options) or read_wind(gusty(tmp_path)),
    )
    options = 'topic=/wind yaw=0.5 direction_convention=from rate=20'
    compose(player={'file': 'bag', 'reader_options': options})
    assert asked == {'topic': '/wind', 'yaw': 0.5, 'direction_convention': 'from', 'rate': 20.0}


@pytest.mark.parametrize(
    ('parameters', 'message'),
    [({}, 'no file to play'), ({'file': 'nowhere.csv'}, 'nowhere.csv'), ({'rate': 0.0}, 'rate')],
)
def test_what_cannot_be_played_says_why(compose, parameters, message):
    with pytest.raises(TreeSwayError, match=message):
        compose(player=parameters)


def test_a_start_behind_the_end_is_refused(compose, wind_file):
    with pytest.raises(TreeSwayError, match='smaller start'):
        compose(player={'file': wind_file, 'start': 100.0})


@pytest.mark.parametrize('epoch', ['1969-06-01T00:00:00Z', '2039-01-01T00:00:00Z'])
def test_a_date_that_no_clock_can_say_is_left_out(compose, observer, tmp_path, epoch, monkeypatch):
    from tree_sway_ros.nodes import player

    record = read_wind(gusty(tmp_path))
    date = datetime.fromisoformat(epoch.replace('Z', '+00:00')).timestamp()
    monkeypatch.setattr(player, 'read_wind', lambda _: dataclasses.replace(record, epoch=date))
    ticks = observer.listen(CLOCK)
    observer.listen(WIND)
    compose(player={'file': 'dated', 'publish_clock': True})
    observer.until(lambda: len(ticks) > 5, '/clock')
    assert 10**9 <= stamp_to_ns(ticks[0].clock) < 5 * 10**9
