# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A robot's wrench on a branch: taken in the segment's tf frame, refused with a reason."""

from contextlib import suppress
import os
from pathlib import Path
import subprocess
import sys
import time

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

pytest.importorskip('rclpy', reason='ROS 2 is not installed')
pytestmark = pytest.mark.ros

from geometry_msgs.msg import Transform, Vector3, Wrench, WrenchStamped  # noqa: E402, I100
from sensor_msgs.msg import MultiDOFJointState  # noqa: E402

from tree_sway_ros.process.topics import PULL, PUSH, SEGMENT_POSES, TF, TF_STATIC  # noqa: E402
from tree_sway_ros.reports.diagnostics import WARN  # noqa: E402


def wrench(frame_id, x=0.0, y=0.0, z=0.0):
    message = WrenchStamped()
    message.header.frame_id = frame_id
    message.wrench.force.x, message.wrench.force.y, message.wrench.force.z = x, y, z
    return message


@pytest.fixture
def pushes(observer):
    return lambda: observer.publisher(PUSH, name='solver/push')


@pytest.mark.parametrize('model', [20, 'auto'])
def test_a_wrench_bends_the_tree_and_lets_go(compose, observer, pushes, tree_file, model):
    solver = compose(solver={'tree': tree_file, 'model': str(model)})['solver']
    frames, push = observer.listen(SEGMENT_POSES), pushes()
    observer.until(lambda: frames, 'a frame')
    # At rest the stem is upright, and the y axis of its frame is level.
    turn = np.array([getattr(frames[0].poses[2].orientation, axis) for axis in 'xyzw'])
    level = Rotation.from_quat(turn).apply([0.0, 1.0, 0.0])[:2]

    def sway():
        tip = frames[-1].poses[2].position
        return tip.x * level[0] + tip.y * level[1]

    rest = sway()
    pull = wrench('tree/stem/2', y=5.0)
    observer.until(lambda: push.publish(pull) or sway() > rest + 2e-3, 'a bend')

    def is_felt():  # it is read while the solver writes it
        return solver.simulator.push_load[:2] @ level == pytest.approx(5.0, rel=0.01)

    observer.until(lambda: push.publish(pull) or is_felt(), 'the force at the foot')
    # Nobody pushes any longer: it ends by itself.
    observer.until(lambda: not solver.simulator.push_load.any(), 'the end of the push')


@pytest.mark.parametrize(
    ('frame_id', 'force', 'why'),
    [
        ('tree/stem/99', 1.0, "'tree/stem/99' is the frame of no segment: one is 'tree/stem/0'"),
        ('stem/1', 1.0, "'stem/1' is the frame of no segment"),
        ('', 1.0, "'' is the frame of no segment"),
        ('tree/stem/1', float('nan'), 'not finite'),
        ('tree/stem/1', 1e6, 'above 100000 N'),
    ],
)
def test_a_push_that_cannot_be_is_refused_and_counted(
    compose, observer, statuses, pushes, tree_file, frame_id, force, why
):
    solver = compose(solver={'tree': tree_file, 'model': '20'})['solver']
    push = pushes()
    wrong = wrench(frame_id, x=force)
    observer.until(lambda: push.publish(wrong) or is_warned(statuses), 'a warning', poll=0.1)
    assert why in statuses('solver: push').message
    assert not solver.simulator.push_load.any()


def pull(frame_id, x=1.0, stiffness=5.0):
    return MultiDOFJointState(
        joint_names=[frame_id],
        transforms=[Transform(translation=Vector3(x=x, z=1.0))],
        wrench=[Wrench(force=Vector3(x=stiffness))],
    )


def test_springs_pull_segments_until_they_are_let_go(compose, observer, tree_file):
    solver = compose(solver={'tree': tree_file, 'model': '20'})['solver']
    hand = observer.publisher(PULL, name='solver/pull')
    held = pull('tree/stem/2')

    def force():
        return float(np.linalg.norm(solver.simulator.push_load[:3]))

    observer.until(lambda: hand.publish(held) or force() > 1.0, 'a force')
    observer.until(lambda: hand.publish(pull('tree/stem/2', stiffness=0.0)) or not force(), 'none')
    assert solver.refusals.statuses()[2].message == 'none refused'


@pytest.mark.parametrize(
    ('wrong', 'why'),
    [
        (pull('stem/2'), "'stem/2' is the frame of no segment: one is 'tree/stem/0'"),
        (pull('tree/stem/2', x=float('nan')), 'pull: to'),
        (pull('tree/stem/2', stiffness=-1.0), 'pull: stiffness'),
        (MultiDOFJointState(joint_names=['tree/stem/2']), 'for each of joint_names'),
    ],
)
def test_a_pull_that_cannot_be_is_refused_with_the_reason(
    compose, observer, statuses, tree_file, wrong, why
):
    solver = compose(solver={'tree': tree_file, 'model': '20'})['solver']
    hand = observer.publisher(PULL, name='solver/pull')

    def is_told():
        hand.publish(wrong)
        status = statuses('solver: pull')
        return status is not None and why in status.message

    observer.until(is_told, 'the reason', poll=0.1)
    assert not solver.simulator.push_load.any()


def test_a_pushed_segment_is_a_frame_of_tf(compose, observer, pushes, tree_file):
    """And so is the tree, at its place; each moves as the poses say."""
    pytest.importorskip('tf2_msgs', reason='tf2_msgs is not installed')
    place = (3.0, 0.0, 0.0, 0.0)
    compose(solver={'tree': tree_file, 'segment_frames': 'stem/1', 'pose': place})
    static, moving = observer.listen(TF_STATIC), observer.listen(TF)
    push, latest = pushes(), {}

    def frames():
        push.publish(wrench('tree/stem/2', y=1.0))
        latest.update({each.child_frame_id: each for m in moving for each in m.transforms})
        return set(latest)

    observer.until(lambda: static and len(frames()) == 2, 'the frames')
    (tree,) = static[0].transforms
    assert (tree.header.frame_id, tree.child_frame_id) == ('map', 'tree')
    assert tree.transform.translation.x == 3.0
    assert set(latest) == {'tree/stem/1', 'tree/stem/2'}
    at = latest['tree/stem/1'].transform.translation
    np.testing.assert_allclose((at.x, at.y, at.z), (3.0, 0.0, 0.5), atol=0.02)


def is_warned(statuses):
    status = statuses('solver: push')
    return status is not None and status.level[0] == WARN


def test_branches_by_themselves_refuse_it(compose, observer, statuses, pushes, tree_file):
    compose(solver={'tree': tree_file, 'model': 'branch'})
    push = pushes()
    observer.until(
        lambda: push.publish(wrench('tree/stem/1', x=1.0)) or is_warned(statuses),
        'a warning', poll=0.1,
    )  # fmt: skip
    assert 'branch' in statuses('solver: push').message


def test_the_example_pulls_and_lets_go(compose, domain, tree_file):
    solver = compose(solver={'tree': tree_file, 'model': '20'})['solver']
    example = Path(__file__).parents[2] / 'examples' / 'python' / 'pull_branch.py'
    command = [sys.executable, example, 'stem/2', '--force', '3', '0', '0', '--seconds', '2']
    environment = os.environ | {'ROS_DOMAIN_ID': str(domain)}
    strongest = 0.0
    with subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, text=True) as process:
        deadline = time.monotonic() + 60.0
        while process.poll() is None and time.monotonic() < deadline:
            strongest = max(strongest, *solver.simulator.push_load[:1])
            with suppress(subprocess.TimeoutExpired):
                process.wait(0.02)
        process.kill()
        assert process.stdout.read() == 'let go of stem/2\n'
    assert 2.0 < strongest <= 3.0
