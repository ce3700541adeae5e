# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Annexes of the solver: taken away, and of one's own."""

import os
from pathlib import Path

import pytest

pytest.importorskip('rclpy', reason='ROS 2 is not installed')
pytestmark = pytest.mark.ros

from std_msgs.msg import Empty  # noqa: E402, I100

from tree_sway.errors import ParameterError  # noqa: E402
from tree_sway_ros.process.topics import SEGMENT_POSES, Topic  # noqa: E402
from tree_sway_ros.solver import simulator_by, SolverAnnex  # noqa: E402

TAKEN_AWAY = """
import atexit, sys
sys.modules['tree_sway_ros.motion'] = None
atexit.register(lambda: print(*sys.modules))
"""
"""As if the folder were deleted; at the end the modules are told."""

MODULE = """
from tree_sway_ros.process import Topic
from tree_sway_ros.reports import OK, Status
from tree_sway_ros.solver import SolverAnnex


class Probe(SolverAnnex):
    def begin(self, run, arrived):
        self.count, self.steps = 0, 0
        topic = Topic(self.node.values['soil'], 'std_msgs/msg/Empty', '')
        self.node.subscription(topic, self._receive)

    def _receive(self, message):
        self.count += 1

    def before_step(self, end, late):
        self.steps += 1

    def statuses(self):
        return [Status('soil', OK, 'heard' if self.count and self.steps else 'silent')]

    def keep(self):
        with open('kept', 'w') as file:
            file.write(str(self.steps))
"""

TABLE = """\
solver:
  soil:
    default: ''
    description: Topic of a probe in the soil.
"""


@pytest.fixture
def soil(tmp_path):
    """Install the package of an annex into a folder."""
    package = tmp_path / 'soil'
    package.mkdir()
    (package / '__init__.py').touch()
    (package / 'probe.py').write_text(MODULE)
    (package / 'probe.yaml').write_text(TABLE)
    known = tmp_path / 'soil-1.0.dist-info'
    known.mkdir()
    (known / 'METADATA').write_text('Metadata-Version: 2.1\nName: soil\nVersion: 1.0\n')
    (known / 'entry_points.txt').write_text('[tree_sway_ros.solver]\nsoil = soil.probe:Probe\n')
    return os.pathsep.join([str(tmp_path), *os.environ.get('PYTHONPATH', '').split(os.pathsep)])


def test_the_solver_sways_without_motion_sensors(run, observer, tree_file):
    process = run('solver', f'tree:={tree_file}', 'imu:=tree/imu@0.5', before=TAKEN_AWAY)
    frames = observer.listen(SEGMENT_POSES)
    observer.until(lambda: frames, 'a frame')
    process.terminate()
    out, err = process.communicate(timeout=30.0)
    assert "unknown parameter 'imu'" in err
    assert process.returncode == 0
    assert 'tree_sway.twin.observed_tree' not in out.split()


def test_what_is_not_asked_for_is_not_loaded(run, observer, tree_file):
    process = run('solver', f'tree:={tree_file}', before=TAKEN_AWAY.replace('sys.modules[', '#'))
    frames = observer.listen(SEGMENT_POSES)
    observer.until(lambda: frames, 'a frame')
    process.terminate()
    out, _ = process.communicate(timeout=30.0)
    assert 'tree_sway_ros.motion' in out.split()
    assert 'tree_sway_ros.motion.annex' not in out.split()


def test_a_sensor_of_ones_own_is_heard_reported_and_kept(
    run, observer, tree_file, statuses, soil, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    process = run('solver', f'tree:={tree_file}', 'soil:=soil/probe', PYTHONPATH=soil)
    probe = observer.publisher(Topic('soil/probe', 'std_msgs/msg/Empty', ''))

    def is_heard():
        probe.publish(Empty())
        report = statuses('solver: soil')
        return report is not None and report.message == 'heard'

    observer.until(is_heard, 'the probe')
    process.terminate()
    _, err = process.communicate(timeout=30.0)
    assert process.returncode == 0, err
    assert int(Path('kept').read_text()) > 0


def test_two_simulators_of_their_own_are_refused():
    class Own(SolverAnnex):
        def simulator(self, scene, settings):
            return object()

    with pytest.raises(ParameterError, match='2 annexes, each with a simulator of its own'):
        simulator_by([Own(None), Own(None)], None, None)
