# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
from pathlib import Path
import signal

import pytest

pytest.importorskip('rclpy', reason='ROS 2 is not installed')
pytestmark = pytest.mark.ros

from tree_sway_ros.nodes import executables  # noqa: E402
from tree_sway_ros.process.composition import NODES  # noqa: E402
from tree_sway_ros.process.topics import SEGMENT_POSES  # noqa: E402
from tree_sway_ros.wire.wind_messages import stamp_to_ns  # noqa: E402

WITHOUT_ROS = "import sys; sys.modules['rclpy'] = None; "


def ended(process):
    """Exit code and what it said on the way."""
    _, errors = process.communicate(timeout=60.0)
    return process.returncode, errors


def started(observer, process, name=None):
    """Frames of a solver that runs; start-up includes imports on a busy machine."""
    frames = observer.listen(SEGMENT_POSES, name=name)
    observer.until(lambda: frames or process.poll() is not None, 'frames', deadline=60.0)
    assert process.poll() is None, process.communicate()[1]
    return frames


@pytest.mark.parametrize(
    'signals',
    [[signal.SIGINT], [signal.SIGTERM], [signal.SIGINT] * 3],
    ids=['int', 'term', 'int3'],
)
def test_a_node_that_is_asked_to_end_ends_well(run, observer, tree_file, signals):
    process = run('solver', f'tree:={tree_file}', 'rate:=40')  # a whole number for a double
    started(observer, process)
    for number in signals:
        process.send_signal(number)
    code, errors = ended(process)
    assert code == 0, errors
    assert 'Traceback' not in errors


@pytest.mark.parametrize(
    ('name', 'parameters', 'environment', 'message'),
    [
        ('solver', ['tree:=elm', 'rats:=40'], {}, "unknown parameter 'rats'; did you mean 'rate'"),
        ('player', [], {}, 'no file to play'),
        ('wind', [], {'ROS_DOMAIN_ID': 'three'}, 'ROS_DOMAIN_ID=three is no domain'),
        ('wind', [], {'ROS_DOMAIN_ID': '300'}, 'ROS_DOMAIN_ID=300 is no domain'),
        ('wind', ['max_speed:=-1.0'], {}, 'give 1 .. 150 [m/s]'),
        ('anemometer', ['rate:=[1'], {}, 'ROS 2 cannot start'),
    ],
)
def test_what_the_user_can_mend_is_one_line_and_exit_code_2(
    run, name, parameters, environment, message
):
    code, errors = ended(run(name, *parameters, **environment))
    assert code == 2, errors
    assert errors.splitlines()[-1].startswith(f'{name}: ')
    assert message in errors
    assert 'Traceback' not in errors


@pytest.mark.parametrize('name', NODES)
def test_help_is_printed_and_no_node_starts(name, capsys):
    for option in ('--help', '-h'):
        with pytest.raises(SystemExit) as ended:
            getattr(executables, name)([option])
        assert ended.value.code == 0
        told = ' '.join(capsys.readouterr().out.split())
        assert f'The {name} node: ' in told
        assert '--ros-args -p name:=value' in told
        assert 'doc/reference.md' in told


@pytest.mark.parametrize('given', [['rate:=40'], ['--rate', '40', '--ros-args']])
def test_what_ros_would_ignore_is_refused(given, capsys):
    with pytest.raises(SystemExit) as ended:
        executables.anemometer(given)
    assert ended.value.code == 2
    told = capsys.readouterr().err
    assert f'anemometer: error: unrecognized arguments: {given[0]}' in told
    assert '--ros-args -p NAME:=VALUE' in told


def test_without_ros_one_line_says_so(run):
    code, errors = ended(run('wind', before=WITHOUT_ROS))
    assert code == 2
    assert len(errors.splitlines()) == 1
    assert 'rclpy' in errors
    assert 'source /opt/ros/jazzy/setup.bash' in errors


def test_killed_and_started_again_it_sways_as_if_nothing_had_been(
    run, compose, observer, tree_file
):
    """Beside it a solver that was never killed; both tick on the same grid."""
    parameters = {'tree': tree_file, 'damping_ratio': 0.5, 'wind_delay': 0.5}
    compose(solver=parameters, wind={}, anemometer={'mean_speed': 8.0})
    steady = observer.listen(SEGMENT_POSES)
    arguments = [f'{name}:={value}' for name, value in parameters.items()]
    remap = ['segment_poses:=mortal', '__node:=mortal']
    process = run('solver', *arguments, remap=remap)
    started(observer, process, 'mortal')
    process.send_signal(signal.SIGKILL)
    process.wait()
    frames = started(observer, run('solver', *arguments, remap=remap), 'mortal')
    begin = stamp_to_ns(frames[0].header.stamp)
    # What remembers longest is the estimate of the sensor's period: 0.9 per sample, 20 per second.
    settled = begin + 8 * 10**9

    def late(messages, newest=0):
        heard = list(messages)[-newest:]
        poses = {stamp_to_ns(m.header.stamp): m.poses[2].position.x for m in heard}
        return {stamp: x for stamp, x in poses.items() if stamp > settled}

    def agree():
        """In the last half second: a wind too late on a busy machine is forgotten, too."""
        ours, theirs = late(frames, newest=200), late(steady, newest=200)
        last = sorted(set(ours) & set(theirs))[-30:]
        return len(last) == 30 and all(abs(ours[stamp] - theirs[stamp]) < 1e-7 for stamp in last)

    observer.until(agree, 'both to sway alike', deadline=120.0)
    assert max(late(frames).values()) > 1e-3


def test_no_name_of_a_tree_steers_the_terminal(run, observer, tmp_path):
    text = (Path(__file__).parents[1] / 'files' / 'data' / 'seedling.yaml').read_text('utf-8')
    evil = tmp_path / 'evil.yaml'
    name = r'name: "oak\e[2J\nready after 0 s"'
    evil.write_text(text.replace('name: seedling', name, 1), encoding='utf-8')
    process = run('solver', f'tree:={evil}')
    started(observer, process)
    process.send_signal(signal.SIGINT)
    code, errors = ended(process)
    assert code == 0, errors
    assert r'oak\x1b[2J ready after 0 s' in errors
    assert '\x1b' not in errors
