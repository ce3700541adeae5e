# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The fixtures of the tests of nodes, and one chain that all rows of a module share."""

from functools import partial
import importlib.util
from pathlib import Path
from unittest.mock import patch

_spec = importlib.util.spec_from_file_location(
    'fixtures_of_nodes', Path(__file__).parents[1] / 'nodes' / 'conftest.py'
)
nodes_conftest = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(nodes_conftest)

import numpy as np  # noqa: E402
import pytest  # noqa: E402

from tree_sway.core.wind.averaging import WindAverage  # noqa: E402, I100

compose, observer, run = nodes_conftest.compose, nodes_conftest.observer, nodes_conftest.run
level, statuses, tree_file = (
    nodes_conftest.level,
    nodes_conftest.statuses,
    nodes_conftest.tree_file,
)

FRAME = 1.0 / 60.0


def numbers_of(pose):
    at, q = pose.position, pose.orientation
    return at.x, at.y, at.z, q.x, q.y, q.z, q.w


class Chain:
    """Anemometer, wind node and solver in one process, heard by another context."""

    def __init__(self, tree, domain):
        from tree_sway_ros.process.composition import Composition
        from tree_sway_ros.process.topics import SEGMENT_POSES, WIND_FILTERED

        self.observer = nodes_conftest.Observer(domain)
        anemometer = {'rate': 50.0, 'mean_speed': 8.0, 'fault_every': 0.6, 'fault_duration': 0.2}
        brief = partial(WindAverage, timeout=0.4, decay=0.3)
        with patch('tree_sway_ros.nodes.solver.WindAverage', brief):
            self.nodes = Composition(
                {
                    'solver': {'tree': tree, 'damping_ratio': 0.3},
                    'wind': {'frozen_after': 1.0, 'timeout': 0.4},
                    'anemometer': anemometer,
                },
                domain_id=domain,
            )
        self.frames = self.observer.listen(SEGMENT_POSES)
        self.filtered = self.observer.listen(WIND_FILTERED)
        self.until(lambda: self.frames and self.filtered, 'the stream')

    def until(self, condition, what):
        self.observer.until(condition, what, deadline=20.0)

    def tell(self, **values):
        """Change the anemometer, as a service would."""
        from rclpy.parameter import Parameter

        changes = [Parameter(name, value=value) for name, value in values.items()]
        result = self.nodes['anemometer'].set_parameters_atomically(changes)
        assert result.successful, result.reason

    @property
    def counts(self):
        return self.nodes['wind']._intake.gate.counts

    def poses(self, first):
        """Poses from a frame on, (frames, segments, 7), and their stamps in [s]."""
        frames = list(self.frames)[first:]
        table = [[numbers_of(pose) for pose in frame.poses] for frame in frames]
        stamps = [f.header.stamp.sec + 1e-9 * f.header.stamp.nanosec for f in frames]
        return np.array(table), np.array(stamps)

    def check_stream(self, first):
        """Whatever came in: finite poses, unit quaternions, stamps that go on, nothing raised."""
        poses, stamps = self.poses(first)
        assert np.isfinite(poses).all()
        assert np.abs(np.linalg.norm(poses[..., 3:], axis=-1) - 1.0).max() < 1e-6
        assert (np.diff(stamps) > 0.0).all()
        self.nodes.check()
        assert all(not node.guard.count for node in self.nodes.nodes)
        return poses, stamps

    def largest_jump(self, first):
        """Largest speed of a tip between two frames in [m/s]."""
        poses, stamps = self.check_stream(first)
        way = np.linalg.norm(np.diff(poses[:, :, :3], axis=0), axis=-1).max(axis=1)
        return float((way / np.diff(stamps)).max())

    def close(self):
        self.nodes.close()
        self.observer.close()


@pytest.fixture(scope='module')
def chain(tmp_path_factory, claimed_domain):
    pytest.importorskip('rclpy', reason='ROS 2 is not installed')
    path = tmp_path_factory.mktemp('faults') / 'sapling.csv'
    path.write_text(nodes_conftest.TREE)
    with claimed_domain() as domain:
        made = Chain(str(path), domain)
        yield made
        made.close()


@pytest.fixture
def faulty(chain):
    """Start a fault of the chain by its kind; afterwards there is none and all is well again."""

    def start(kind, **more):
        chain.tell(fault=kind, **more)
        return len(chain.frames)

    yield start
    chain.tell(fault='none', fault_every=0.6, fault_duration=0.2)
    n = len(chain.filtered)
    chain.until(lambda: len(chain.filtered) > n + 30, 'good wind again')
