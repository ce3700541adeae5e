# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Motion sensors over ROS: topics by a parameter, covariances, and a report of each."""

from dataclasses import replace
import time
from types import SimpleNamespace

import numpy as np
import pytest

pytest.importorskip('rclpy', reason='ROS 2 is not installed')
pytestmark = pytest.mark.ros

from sensor_msgs.msg import Imu  # noqa: E402, I100
from tree_sway_lab.twin.simulated_sensor import SimulatedSensor  # noqa: E402

from tree_sway.core.scene.make import make_simulator  # noqa: E402
from tree_sway.core.scene.run import Run  # noqa: E402
from tree_sway.core.species.species import species_named  # noqa: E402
from tree_sway.core.wind.intake import WindIntake  # noqa: E402
from tree_sway.core.wind.turbulence import simulate_turbulence  # noqa: E402
from tree_sway.errors import FormatError, ParameterError  # noqa: E402
from tree_sway.files.trees.source import open_tree  # noqa: E402
from tree_sway.growth.builtin import builtin_tree  # noqa: E402
from tree_sway.simulation.rig import PlacedMotion, simulate  # noqa: E402
from tree_sway.twin.observed_tree import ObservedTree  # noqa: E402
from tree_sway.twin.sway_watch import SwayChange  # noqa: E402
from tree_sway.twin.tree_fit import TreeFit  # noqa: E402
from tree_sway_ros.motion.imu_intake import ImuIntake, places_of  # noqa: E402
from tree_sway_ros.nodes.recorded_imu import RecordedImu  # noqa: E402
from tree_sway_ros.process.topics import IMU  # noqa: E402
from tree_sway_ros.reports.diagnostics import OK, WARN  # noqa: E402
from tree_sway_ros.solver.sample_wait import UNHEARD  # noqa: E402
from tree_sway_ros.wire.imu_messages import motion_from_message  # noqa: E402


def imu(stamp=0.0, up=9.81, rate=0.0):
    message = Imu()
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(round(stamp * 1e9), 10**9)
    message.linear_acceleration.z = up
    message.angular_velocity.x = rate
    message.orientation_covariance[0] = -1.0
    return message


def test_topics_have_places_of_their_own():
    found = places_of(' tree/imu@3.2, limb/imu@b12:0.5 ')
    assert found == {'tree/imu': '3.2', 'limb/imu': 'b12:0.5'}
    assert places_of('') == {}


@pytest.mark.parametrize('text', ['imu', 'imu@', '@3.2', 'imu@1, imu@2'])
def test_another_text_is_refused_with_an_example(text):
    with pytest.raises(ParameterError, match='no topic with a place') as caught:
        places_of(text)
    assert 'tree/imu@3.2' in caught.value.cure


@pytest.mark.parametrize('name', ['tree bad/imu', '2tree/imu', 'tree//imu', 'tree/imu/'])
def test_what_is_no_name_of_a_topic_is_refused(name, tmp_path):
    with pytest.raises(ParameterError, match='is no name of a topic'):
        places_of(f'{name}@3.2')
    with pytest.raises(ParameterError, match='is no name of a topic'):
        RecordedImu(str(tmp_path), name, None)


def test_motion_is_played_from_bags_alone(tmp_path):
    wind = tmp_path / 'wind.csv'
    wind.write_text('time,u,v\n0,1,2\n')
    with pytest.raises(FormatError, match='leave imu out, or give a bag'):
        RecordedImu(str(wind), 'tree/imu', None)


def test_covariances_say_what_is_measured_and_how_well():
    message = imu(12.5)
    message.linear_acceleration_covariance[:] = np.diag([0.04, 0.09, 0.01]).ravel()
    found = motion_from_message(message)
    assert found.stamp == 12_500_000_000
    assert found.orientation is None
    assert found.acceleration == (0.0, 0.0, 9.81)
    assert found.noise == pytest.approx((0.3, 0.0, 0.0))
    message.angular_velocity_covariance[0] = -1.0
    assert motion_from_message(message).rate is None


PARAMETERS = {'imu': 'tree/imu@segment:2'}
REPORT = 'solver: imu tree/imu'


def test_a_sensor_is_heard_and_reported(compose, observer, tree_file, statuses):
    solver = compose(solver={'tree': tree_file, **PARAMETERS})['solver']
    publisher = observer.publisher(IMU, name='tree/imu')

    def is_counted():
        now = time.time()
        for message in (imu(now), imu(now, up=float('nan')), imu(now - 3600.0)):
            publisher.publish(message)
        if (report := statuses(REPORT)) is None:
            return False
        values = {each.key: each.value for each in report.values}
        names = ('accepted', 'refused', 'refused for their stamps')
        return all(int(values[name]) > 5 for name in names)

    observer.until(is_counted, 'counts of each kind')
    assert statuses(REPORT).level[0] == WARN
    assert 'mounting' in statuses(REPORT).message
    assert solver.guard.count == 0


def test_a_clock_of_its_own_is_told_with_the_cure(compose, observer, tree_file, statuses):
    compose(solver={'tree': tree_file, **PARAMETERS})
    publisher = observer.publisher(IMU, name='tree/imu')

    def is_told():
        publisher.publish(imu(12.0))
        report = statuses(REPORT)
        return report is not None and 'synchronise the clocks' in report.message

    observer.until(is_told, 'the cure')


def test_of_two_publishers_of_a_topic_one_is_followed(compose, observer, tree_file, statuses):
    compose(solver={'tree': tree_file, **PARAMETERS})
    first = observer.publisher(IMU, name='tree/imu')

    def values_after(*publishers):
        for publisher in publishers:
            publisher.publish(imu(time.time()))
        if (report := statuses(REPORT)) is None:
            return {}
        return {each.key: each.value for each in report.values}

    observer.until(lambda: int(values_after(first).get('accepted', 0)) > 5, 'the first')
    second = observer.publisher(IMU, name='tree/imu')
    key = 'of other publishers, refused'
    observer.until(lambda: int(values_after(first, second)[key]) > 5, 'the second')
    assert '2 publishers: ' in statuses(REPORT).message
    assert 'one is followed' in statuses(REPORT).message
    assert statuses(REPORT).level[0] == WARN


PERIOD = 16_666_667
BEGIN = 60_000 * PERIOD
"""Period of the steps, and stamp of the first sample [ns]."""


class IntakeNode:
    """The part of a node that the intake of a sensor calls, without a graph."""

    stamp_limits = {'lead': 10**12, 'lag': 10**12}  # noqa: RUF012

    def __init__(self, publishers=1):
        self.receive, self.now = None, BEGIN
        self._publishers = publishers

    def count_publishers(self, topic):
        return self._publishers

    def publishers_of(self, topic, _type_name):
        return [topic] * self._publishers

    def subscription(self, topic, receive):
        self.receive = receive

    def get_clock(self):
        return SimpleNamespace(now=lambda: SimpleNamespace(nanoseconds=self.now))


def intake_of(twin, node=None, run=None, arrived=lambda: None):
    intake = ImuIntake(node or IntakeNode())
    intake.twin = twin
    intake.begin(run or Run(twin, 60.0), arrived)
    return intake


@pytest.mark.parametrize(('jump', 'said'), [(60.0, 'by 60.0 s: synchronise'), (None, 'battery')])
def test_a_followed_sensor_whose_clock_jumps_is_not_one_that_is_silent(jump, said):
    twin = ObservedTree(builtin_tree('goldcrest'), at={'tree/imu': 'segment:3'}, rate=60.0)
    node = IntakeNode()
    node.stamp_limits = {'lead': 0, 'lag': 0}
    run = Run(twin, 60.0, starting=lambda end, _: twin.set_time(end))
    intake = intake_of(twin, node, run)
    node.receive(imu(BEGIN * 1e-9 - 3600.0), {})  # before its clock is set
    for k in range(120):
        node.now = BEGIN + k * PERIOD
        if k < 30 or jump is not None:
            ahead = 0.0 if k < 30 else jump
            node.receive(imu(node.now * 1e-9 + ahead, rate=0.001 * k), {})
        run.advance(node.now)
    (status,) = intake.statuses()
    assert status.values['accepted'] == 30
    assert said in status.message
    assert ('silent' in status.message) == (jump is None)


def test_a_step_lacks_the_motion_that_it_reads_until_that_arrives():
    twin = ObservedTree(builtin_tree('goldcrest'), at={'tree/imu': 'segment:3'}, rate=60.0)
    arrived = []
    node, run = IntakeNode(), Run(twin, 60.0)
    intake = intake_of(twin, node, run, lambda: arrived.append(True))
    assert list(intake.lacking(BEGIN, 0.0)) == [('tree/imu', UNHEARD)]
    node.receive(imu(BEGIN * 1e-9), {})
    assert arrived
    # Samples within half a period about the time are averaged.
    assert list(intake.lacking(BEGIN, 0.0)) == [('tree/imu', BEGIN)]
    assert not list(intake.lacking(BEGIN, 0.01))
    node.receive(imu((BEGIN + PERIOD) * 1e-9), {})
    assert not list(intake.lacking(BEGIN, 0.0))
    assert list(intake.lacking(BEGIN + PERIOD, 0.0)) == [('tree/imu', BEGIN + PERIOD)]


def test_a_topic_that_nobody_publishes_is_not_waited_for():
    twin = ObservedTree(builtin_tree('goldcrest'), at={'tree/imu': 'segment:3'}, rate=60.0)
    intake = intake_of(twin, IntakeNode(publishers=0))
    assert not list(intake.lacking(BEGIN, 0.0))


def test_a_status_has_what_was_learned(monkeypatch):
    twin = ObservedTree(builtin_tree('goldcrest'), at={'tree/imu': 'segment:3'}, rate=60.0)
    intake = intake_of(twin)
    (status,) = intake.statuses()
    assert 'first frequency [Hz]' not in status.values
    as_made = float(twin.frequencies(1)[0])
    monkeypatch.setattr(twin.observer._fit, 'found', TreeFit(1.0, 1.4, 0.1, 0.2, 0.9, 0.2, 0.5))
    (status,) = intake.statuses()
    assert status.values['first frequency [Hz]'] == pytest.approx(as_made, abs=1e-4)
    assert status.values['damping over that of the file'] == 1.4
    assert status.values['drag over that of the file'] == 0.9
    assert status.values['learned from [h]'] == 0.5


def test_a_status_says_how_sure_the_motion_is():
    twin = ObservedTree(
        builtin_tree('goldcrest'), at={'tree/imu': 'segment:3'}, rate=60.0, has_band=True
    )
    run = Run(twin, 60.0)
    intake = intake_of(twin, run=run)
    for k in range(120):
        run.offer(BEGIN + k * PERIOD, (4.0, 0.0, 0.0), BEGIN + k * PERIOD)
        run.advance(BEGIN + k * PERIOD)
        intake.statuses()
    (status,) = intake.statuses()
    low, high = (
        status.values[f'highest tip of 80 % of trees, {end} [m]'] for end in ('from', 'to')
    )
    assert low < 0.0 < high < 0.5


def test_a_status_warns_of_a_tree_that_sways_differently(monkeypatch):
    twin = ObservedTree(builtin_tree('goldcrest'), at={'tree/imu': 'segment:3'}, rate=60.0)
    intake = intake_of(twin)
    (track,) = twin.observer.tracks
    monkeypatch.setattr(track.native, 'in_use', 1)
    (watch,) = twin.observer._fit.watches
    for ratio, level, said in ((1.01, OK, 'as before'), (1.2, WARN, 'differently')):
        monkeypatch.setattr(watch, 'change', SwayChange(ratio, 0.02, 3.0))
        (status,) = intake.statuses()
        assert status.level == level
        assert f'sways {said}' in status.message
        assert status.values['frequencies over those before'] == ratio


def test_the_solver_keeps_what_was_learned(compose, tmp_path, tree_file, monkeypatch):
    path = tmp_path / 'own.twin.yaml'
    for run in (1, 2):
        made = compose(solver={'tree': tree_file, 'learn': str(path), **PARAMETERS})
        solver = made['solver']
        fit = TreeFit(0.9, 1.2, 0.02, 0.2, 0.9, 0.2, 1.0)
        monkeypatch.setattr(solver.simulator.observer._fit, 'found', fit)
        made.close()  # as at Ctrl-C
        assert open_tree(str(path)).learned.hours == pytest.approx(run)


def test_a_file_to_learn_without_a_sensor_is_refused(compose, tmp_path, tree_file):
    with pytest.raises(ParameterError, match='no motion sensor to learn from'):
        compose(solver={'tree': tree_file, 'learn': str(tmp_path / 'own.yaml')})


def test_messages_move_a_tree_as_a_recording_does():
    """`simulate` and the steps of the solver, which follow the wind later, give one motion."""
    tree, at = builtin_tree('goldcrest'), 'segment:3'
    softer = replace(species_named('goldcrest'), modulus=6.0e9)
    rng, dt = np.random.default_rng(21), PERIOD * 1e-9
    wind = simulate_turbulence(4.0, rate=60.0, duration=40.0, rng=rng)
    true, poses = make_simulator(tree, softer, crown_coherence=0.3), np.empty((len(wind), 7))
    for k, each in enumerate(wind):
        true.step(each, dt)
        poses[k] = true.place()[3]
    motion = SimulatedSensor(rate=60.0).measured(poses, dt, rng)
    placed = PlacedMotion('tree/imu', at, motion.time, motion.acceleration, motion.rate)
    record = SimpleNamespace(time=dt * np.arange(0, len(wind), 6), velocity=wind[::6])
    known = simulate(tree, record, motion=[placed])
    assert not any('mounting' in note for note in known.notes)

    twin = ObservedTree(tree, at={'tree/imu': at}, rate=60.0)
    tips = []
    run = Run(
        twin, 60.0, intake=WindIntake.of_velocities(),
        starting=lambda end, late: twin.set_time(end - late),  # as late as the wind
        stepped=lambda end, mean: tips.append(twin.tip_displacement.copy()),
    )  # fmt: skip
    node = IntakeNode()
    intake_of(twin, node, run)
    for stamp, force, rate in zip(motion.time, motion.acceleration, motion.rate, strict=True):
        message = imu(BEGIN * 1e-9 + stamp)
        for vector, values in (
            (message.linear_acceleration, force),
            (message.angular_velocity, rate),
        ):
            vector.x, vector.y, vector.z = values.tolist()
        node.receive(message, {})
    for k, each in enumerate(wind.tolist()):
        if k % 6 == 0:
            run.offer(BEGIN + k * PERIOD, tuple(each), BEGIN + k * PERIOD)
        run.advance(BEGIN + k * PERIOD, delay=dt)
    assert twin.observer.is_active
    later = slice(37 * 60, len(known.tips) - 12)
    wanted = known.tips[later, 0]
    found = np.array(tips)
    # A period of the wind of six steps, a delay of one, and a first step at the first stamp.
    late = 6 + 1 + 1
    wrong = found[later.start + late : later.stop + late] - wanted
    assert np.std(wrong, axis=0).max() < 0.01 * np.std(wanted, axis=0).max()


def test_sensors_on_a_forest_are_refused(compose, tmp_path, tree_file):
    path = tmp_path / 'glade.yaml'
    path.write_text(
        f'trees:\n- {{name: oak, tree: {tree_file}}}\n- {{name: elm, tree: {tree_file}, x: 3}}\n'
    )
    with pytest.raises(ParameterError, match='motion sensors on a scene of 2 trees'):
        compose(solver={'tree': str(path), 'imu': 'tree/imu@0.5'})
