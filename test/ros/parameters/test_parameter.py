# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import inspect
import math
from pathlib import Path

from hypothesis import given
from hypothesis import strategies as st
import pytest
import yaml

from tree_sway.core.settings import MOST, Settings  # noqa: I100
from tree_sway.core.wind.convention import WindConvention
from tree_sway.core.wind.gate import WindGate
from tree_sway.core.wind.limits import FASTEST_WIND
from tree_sway.errors import ParameterError
from tree_sway.parameters.parameter import Parameter
from tree_sway.simulation.wind.sensor_faults import FAULTS
from tree_sway_ros.parameters.node_parameters import NODE_PARAMETERS

ROOT = Path(__file__).parents[3]
SPEED = Parameter('speed', 6.0, 'Mean speed.', 'm/s', 0.0, 40.0)
SOLVER = NODE_PARAMETERS['solver']
EVERY = [p for table in NODE_PARAMETERS.values() for p in table]


@pytest.mark.parametrize('parameter', EVERY, ids=lambda p: p.name)
def test_a_default_is_good(parameter):
    assert parameter.checked(parameter.default) == parameter.default
    assert parameter.description.endswith('.')


def test_choices_are_those_of_the_library():
    (fault,) = (each for each in NODE_PARAMETERS['anemometer'] if each.name == 'fault')
    assert fault.choices == FAULTS


def test_the_defaults_and_limits_are_those_of_the_library():
    solver, settings = {each.name: each for each in SOLVER}, Settings()
    assert solver['model'].default == str(settings.model)
    assert solver['model'].most == MOST
    assert solver['gravity'].default == settings.gravity
    assert solver['volume_rule.damping'].default == settings.volume_damping
    assert solver['profile'].default == settings.profile.kind
    assert solver['anemometer_height'].default == settings.profile.anemometer_height
    (fastest,) = (each for each in NODE_PARAMETERS['wind'] if each.name == 'max_speed')
    assert fastest.maximum == FASTEST_WIND


@pytest.mark.parametrize('table', NODE_PARAMETERS.values(), ids=list(NODE_PARAMETERS))
def test_names_are_unique(table):
    assert len({each.name for each in table}) == len(table)


@given(st.floats(0.0, 40.0))
def test_a_number_in_range_is_taken_as_it_is(value):
    assert SPEED.checked(value) == value


@given(st.one_of(st.floats(max_value=-1e-9), st.floats(min_value=40.0000001), st.just(math.nan)))
def test_any_other_number_is_refused(value):
    with pytest.raises(ParameterError, match=r'give 0 \.\. 40 \[m/s\]'):
        SPEED.checked(value)


def test_a_whole_number_will_do_for_a_float():
    value = SPEED.checked(4)
    assert value == 4.0
    assert type(value) is float


@pytest.mark.parametrize(
    ('default', 'bad'),
    [
        (1.0, True),
        (1.0, '4'),
        (1, 1.5),
        (1, True),
        (True, 2),
        (True, 'yes'),
        ('a', 3),
        ((0.0, 1.0), (1.0,)),
    ],
)
def test_another_kind_is_refused(default, bad):
    with pytest.raises(ParameterError, match="parameter 'x'"):
        Parameter('x', default, 'X.').checked(bad)


@pytest.mark.parametrize('bad', ['01', [1.0, math.inf], [1.0, 3.0], 7])
def test_a_bad_list_is_refused(bad):
    with pytest.raises(ParameterError):
        Parameter('x', (0.0, 1.0), 'X.', minimum=0.0, maximum=2.0).checked(bad)


def test_a_list_becomes_numbers():
    assert Parameter('x', (0.0, 1.0), 'X.').checked([1, 2.5]) == (1.0, 2.5)


def test_a_choice_that_is_not_there_names_the_nearest():
    parameter = Parameter('source', 'player', 'Source.', choices=('player', 'live'))
    with pytest.raises(ParameterError, match="did you mean 'player'"):
        parameter.checked('playr')


def test_a_type_is_named_as_ros_names_it_with_msg_or_without():
    output = next(p for p in NODE_PARAMETERS['wind'] if p.name == 'input_type')
    for name in ('geometry_msgs/msg/TwistStamped', 'geometry_msgs/TwistStamped'):
        assert output.checked(name) == 'geometry_msgs/TwistStamped'


@pytest.mark.parametrize('word', ['True', 'true', '1', 1, True])
def test_yes_is_yes_however_it_is_written(word):
    assert Parameter('on', False, 'On.').checked(word) is True


@pytest.mark.parametrize(
    ('node', 'make'),
    [('wind', WindConvention), ('wind', WindGate), ('solver', Settings)],
)
def test_the_core_takes_both_ends_of_each_range(node, make):
    taken = set(inspect.signature(make).parameters) - {'damping_ratio'}
    bounded = [p for p in NODE_PARAMETERS[node] if p.name in taken and p.minimum is not None]
    assert bounded
    for parameter in bounded:
        if isinstance(parameter.default, float):
            for end in (parameter.minimum, parameter.maximum):
                make(**{parameter.name: end})


PARAMETER_FILES = sorted(
    p for p in (ROOT / 'config').glob('*.yaml') if p.stem not in ('forest', 'stand')
)


def test_every_node_has_a_file_in_config():
    assert {path.stem for path in PARAMETER_FILES} == set(NODE_PARAMETERS)


@pytest.mark.parametrize('path', PARAMETER_FILES, ids=lambda p: p.stem)
def test_the_files_in_config_are_good_and_repeat_no_default(path):
    document = yaml.safe_load(path.read_text())
    assert document
    for node, body in document.items():
        assert set(body) == {'ros__parameters'}
        table = NODE_PARAMETERS[node.rsplit('/', 1)[-1]]
        by_name = {each.name: each for each in table}
        for name, value in body['ros__parameters'].items():
            assert by_name[name].checked(value) != by_name[name].default
