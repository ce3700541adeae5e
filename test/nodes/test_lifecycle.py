# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import pytest

pytest.importorskip('rclpy', reason='ROS 2 is not installed')
pytestmark = pytest.mark.ros

from lifecycle_msgs.msg import Transition  # noqa: E402, I100
from lifecycle_msgs.srv import ChangeState, GetState  # noqa: E402

from tree_sway_ros.process.topics import SEGMENT_POSES, WIND, WIND_FILTERED  # noqa: E402

STATES = {
    Transition.TRANSITION_CONFIGURE: 'inactive',
    Transition.TRANSITION_ACTIVATE: 'active',
    Transition.TRANSITION_DEACTIVATE: 'inactive',
    Transition.TRANSITION_CLEANUP: 'unconfigured',
}
"""State after each transition."""


@pytest.fixture
def manage(observer):
    """Return a function that makes a transition, and whether the node is in its state then."""

    def change(node, transition):
        request = ChangeState.Request(transition=Transition(id=transition))
        response = observer.call(ChangeState, f'{node}/change_state', request)
        # If the first response was lost, the second one refuses to do it again.
        return response.success or state_of(observer, node) == STATES[transition]

    return change


def state_of(observer, node):
    return observer.call(GetState, f'{node}/get_state', GetState.Request()).current_state.label


def is_published(observer, messages):
    n = len(messages)
    observer.until(lambda: len(messages) > n + 5, 'messages')


def is_silent(observer, messages, others):
    """Nothing more comes while others continue, but for what was sent before and is heard late."""
    for _ in range(2):
        n, m = len(messages), len(others)
        observer.until(lambda m=m: len(others) > m + 10, 'others')
    assert len(messages) <= n + 1


def test_a_managed_chain_is_configured_started_stopped_and_started_again(
    compose, observer, manage, tree_file
):
    managed = {'autostart': False}
    compose(anemometer=managed, wind=managed, solver={'tree': tree_file, **managed})
    frames, said = observer.listen(SEGMENT_POSES), observer.listen(WIND)
    filtered = observer.listen(WIND_FILTERED)
    assert state_of(observer, 'solver') == 'unconfigured'
    names = ('anemometer', 'wind', 'solver')
    for node in names:
        assert manage(node, Transition.TRANSITION_CONFIGURE)
    assert (frames, said) == ([], [])
    for node in names:
        assert manage(node, Transition.TRANSITION_ACTIVATE)
    is_published(observer, frames)
    is_published(observer, filtered)
    assert manage('wind', Transition.TRANSITION_DEACTIVATE)
    is_silent(observer, filtered, said)
    assert manage('solver', Transition.TRANSITION_DEACTIVATE)
    is_silent(observer, frames, said)
    for node in ('wind', 'solver'):
        assert manage(node, Transition.TRANSITION_CLEANUP)
        assert manage(node, Transition.TRANSITION_CONFIGURE)
        assert manage(node, Transition.TRANSITION_ACTIVATE)
    is_published(observer, frames)
    is_published(observer, filtered)
    assert state_of(observer, 'solver') == 'active'


def test_what_cannot_be_configured_says_so_and_stays_as_it_was(compose, observer, manage):
    nodes = compose(solver={'tree': 'elm.yaml', 'autostart': False})
    before = len(list(nodes['solver'].publishers))
    assert not manage('solver', Transition.TRANSITION_CONFIGURE)
    assert state_of(observer, 'solver') == 'unconfigured'
    assert len(list(nodes['solver'].publishers)) == before


@pytest.mark.parametrize(
    'wanted',
    [
        Transition(id=Transition.TRANSITION_ACTIVATE),
        Transition(label='activate'),
        Transition(id=250),
        Transition(label='grow'),
    ],
    ids=lambda each: each.label or str(each.id),
)
def test_a_transition_that_is_not_possible_is_refused_and_no_failure(compose, observer, wanted):
    # A client whose response was lost asks again, when the node is in its new state.
    compose(wind={'autostart': False})  # it asks for no failures of callbacks
    request = ChangeState.Request(transition=wanted)
    assert not observer.call(ChangeState, 'wind/change_state', request).success
    assert state_of(observer, 'wind') == 'unconfigured'
