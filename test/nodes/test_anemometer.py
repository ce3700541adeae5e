# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

pytest.importorskip('rclpy', reason='ROS 2 is not installed')
pytestmark = pytest.mark.ros

from geometry_msgs.msg import Vector3Stamped  # noqa: E402, I100
from rcl_interfaces.srv import SetParameters  # noqa: E402
from rclpy.parameter import Parameter  # noqa: E402

from tree_sway.errors import TreeSwayError  # noqa: E402
from tree_sway.simulation.wind.anemometer import AnemometerModel  # noqa: E402
from tree_sway_ros.process.topics import WIND  # noqa: E402


def test_samples_come_at_the_rate_and_are_the_models(compose, observer):
    compose(anemometer={'rate': 50.0, 'seed': 3, 'mean_speed': 8.0})
    said = observer.listen(WIND)
    observer.until(lambda: len(said) > 40, 'wind')
    stamps = np.array([m.header.stamp.sec * 10**9 + m.header.stamp.nanosec for m in said])
    periods = np.diff(stamps) / 2e7
    np.testing.assert_allclose(periods, np.round(periods), atol=1e-9)
    model = AnemometerModel(8.0, intensity=0.2, rate=50.0, seed=3, bearing_to=1.5708)
    known = {tuple(model.sample(tick)) for tick in range(2000)}
    assert all((m.vector.x, m.vector.y, m.vector.z) in known for m in said)


def test_the_wind_changes_while_it_blows(compose, observer):
    nodes = compose(anemometer={'intensity': 0.0, 'rate': 50.0})
    said = observer.listen(WIND)
    observer.until(lambda: said, 'wind')
    assert said[-1].vector.x == pytest.approx(6.0)
    (result,) = nodes['anemometer'].set_parameters([Parameter('mean_speed', value=9)])
    assert result.successful
    observer.until(lambda: said[-1].vector.x == pytest.approx(9.0), '9 m/s')
    (result,) = nodes['anemometer'].set_parameters([Parameter('mean_speed', value=99.0)])
    assert not result.successful
    n = len(said)
    observer.until(lambda: len(said) > n + 2, 'more wind')
    assert said[-1].vector.x == pytest.approx(9.0)


def test_faults_that_overlap_are_refused(compose):
    with pytest.raises(TreeSwayError, match='every'):
        compose(anemometer={'fault': 'spike', 'fault_duration': 5.0, 'fault_every': 1.0})


@pytest.mark.parametrize(('name', 'value'), [('fault_every', 0.5), ('fault_duration', 21.0)])
def test_a_live_change_that_overlaps_faults_is_refused_with_an_answer(
    compose, observer, name, value
):
    """Each value is in its range; together they cannot be."""
    compose(anemometer={'fault': 'dropout', 'rate': 50.0})
    request = SetParameters.Request(parameters=[Parameter(name, value=value).to_parameter_msg()])
    (result,) = observer.call(SetParameters, 'anemometer/set_parameters', request).results
    assert not result.successful
    assert 'overlap' in result.reason
    said = observer.listen(WIND)
    observer.until(lambda: len(said) > 5, 'wind that goes on')


def test_both_together_are_taken(compose):
    nodes = compose(anemometer={'fault': 'dropout'})
    changes = [Parameter('fault_every', value=30.0), Parameter('fault_duration', value=25.0)]
    assert nodes['anemometer'].set_parameters_atomically(changes).successful


def test_an_ordinary_subscription_hears_the_wind(compose, observer):
    """As `ros2 topic echo` and most programs subscribe: reliable."""
    said = []
    compose(anemometer={'rate': 50.0})
    observer.node.create_subscription(Vector3Stamped, WIND.name, said.append, 10)
    observer.until(lambda: said, 'wind')
