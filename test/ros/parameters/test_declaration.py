# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import pytest

pytest.importorskip('rclpy')
pytestmark = pytest.mark.ros

from rcl_interfaces.msg import ParameterType  # noqa: E402
from rclpy.node import Node  # noqa: E402
from rclpy.parameter import Parameter as RosParameter  # noqa: E402
from rclpy.qos import ReliabilityPolicy  # noqa: E402

from tree_sway.errors import ParameterError  # noqa: E402
from tree_sway.parameters.parameter import Parameter  # noqa: E402
from tree_sway_ros.nodes.wind import WindNode  # noqa: E402
from tree_sway_ros.parameters.declaration import ParameterValues  # noqa: E402

TABLE = (
    Parameter('rate', 60.0, 'Rate.', 'Hz', 1.0, 1000.0),
    Parameter('delay', 0.1, 'Delay.', 's', 0.0, 2.0, live=True),
    Parameter('every', 1, 'Every.', '', 1, 10, live=True),
    Parameter('normal', (0.0, 0.0, 1.0), 'Normal.', '', -1.0, 1.0, live=True),
    Parameter('kind', 'to', 'Kind.', choices=('to', 'from')),
    Parameter('on', False, 'On.', live=True),
)


@pytest.fixture
def declare(context):
    nodes = []

    def make(on_change=lambda values: None, **overrides):
        node = Node(
            'some',
            context=context,
            automatically_declare_parameters_from_overrides=True,
            parameter_overrides=[RosParameter(k, value=v) for k, v in overrides.items()],
        )
        nodes.append(node)
        return node, ParameterValues(node, TABLE, on_change)

    yield make
    for node in nodes:
        node.destroy_node()


def change(node, name, value):
    (result,) = node.set_parameters([RosParameter(name, value=value)])
    return result


def test_defaults_and_overrides(declare):
    node, values = declare(rate=40, normal=[0, 1, 0])
    assert values['rate'] == 40.0
    assert type(values['rate']) is float
    assert values['normal'] == (0.0, 1.0, 0.0)
    assert values.subset('delay', 'kind') == {'delay': 0.1, 'kind': 'to'}
    assert node.get_parameter('every').value == 1


def test_descriptors_describe_unit_and_range(declare):
    node, _ = declare()
    rate, every = node.describe_parameter('rate'), node.describe_parameter('every')
    assert rate.description == 'Rate. [Hz]'
    assert 'read at start only' in rate.additional_constraints
    assert rate.floating_point_range[0].to_value == 1000.0
    assert every.integer_range[0].from_value == 1
    assert every.type == ParameterType.PARAMETER_INTEGER


@pytest.mark.parametrize(
    ('overrides', 'message'),
    [
        ({'rate': 0.5}, '1 .. 1000'),
        ({'kind': 'fro'}, 'from'),
    ],
)
def test_a_bad_start_is_refused(declare, overrides, message):
    with pytest.raises(ParameterError, match=message):
        declare(**overrides)


def test_a_live_change_is_taken_and_reported(declare):
    reports = []
    node, values = declare(reports.append)
    assert change(node, 'delay', 1).successful
    assert values['delay'] == 1.0
    assert reports == [{'delay': 1.0}]


@pytest.mark.parametrize(
    ('name', 'value', 'reason'),
    [
        ('delay', 3.0, 'out of range'),
        ('delay', 3, 'out of range'),
        ('delay', 'soon', 'not a number'),
        ('delay', None, 'not a number'),
        ('every', 1.5, 'not a whole number'),
        ('rate', 30.0, 'read-only parameter: rate'),
        ('normal', [0.0, 1.0], 'not 3 numbers'),
    ],
)
def test_a_bad_change_is_refused_with_the_reason(declare, name, value, reason):
    reports = []
    node, values = declare(reports.append)
    before = values[name]
    result = change(node, name, value)
    assert not result.successful
    assert reason in result.reason
    assert values[name] == before
    shown = node.get_parameter(name).value
    assert (tuple(shown) if isinstance(before, tuple) else shown) == before
    assert reports == []


@pytest.mark.parametrize(
    ('name', 'value'), [('delay', 1), ('every', 2.0), ('on', 1), ('on', 'True')]
)
def test_a_value_keeps_its_kind_in_ros_too(declare, name, value):
    """A double that was set to 1 is still a double: the next 1.5 is taken."""
    node, values = declare()
    kind = node.get_parameter(name).type_
    assert change(node, name, value).successful
    assert node.get_parameter(name).type_ == kind
    assert values[name].__class__ is node.get_parameter(name).value.__class__
    assert change(node, 'delay', 1.5).successful


def test_what_is_read_at_the_start_is_read_only(declare):
    node, _ = declare()
    assert node.describe_parameter('rate').read_only
    assert not node.describe_parameter('delay').read_only


def test_an_unknown_name_is_a_warning_with_the_nearest(declare, capfd):
    node, _ = declare(rats=1.0, shutter=3)
    said = capfd.readouterr().err
    assert "unknown parameter 'rats'; did you mean 'rate'?" in said
    assert "unknown parameter 'shutter'; known are: rate" in said
    assert not node.has_parameter('rats')


def test_the_quality_of_service_of_a_topic_can_be_described(context):
    overrides = {
        'qos_overrides./wind/filtered.publisher.depth': 3,
        'qos_overrides./wind.subscription.reliability': 'reliable',
    }
    node = WindNode(
        context=context,
        parameter_overrides=[RosParameter(k, value=v) for k, v in overrides.items()],
        use_global_arguments=False,
    )
    by_name = {each.topic_name: each for each in (*node.publishers, *node.subscriptions)}
    assert by_name['/wind/filtered'].qos_profile.depth == 3
    assert by_name['/wind'].qos_profile.reliability == ReliabilityPolicy.RELIABLE
    node.close()
