# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
from pathlib import Path
import threading

import pytest

pytest.importorskip('rclpy', reason='ROS 2 is not installed')
pytestmark = pytest.mark.ros

from builtin_interfaces.msg import Time  # noqa: E402, I100
from rosgraph_msgs.msg import Clock  # noqa: E402

from tree_sway.errors import TreeSwayError  # noqa: E402
from tree_sway_ros.process.composition import Composition  # noqa: E402
from tree_sway_ros.process.topics import CLOCK, WIND_FILTERED  # noqa: E402
from tree_sway_ros.reports.diagnostics import WARN  # noqa: E402


def threads_of_fast_dds():
    """Return the threads that Python does not know."""
    names = [each.read_text() for each in Path('/proc/self/task').glob('*/comm')]
    return sorted(name for name in names if name.startswith('dds.ev'))


def test_it_closes_twice_and_leaves_no_thread(domain):
    before, of_dds = set(threading.enumerate()), threads_of_fast_dds()
    with Composition({'wind': {}, 'anemometer': {}}, domain_id=domain) as nodes:
        assert nodes['wind'].get_name() == 'wind'
        nodes.check()
        assert not nodes.is_done
    nodes.close()
    assert set(threading.enumerate()) == before
    assert threads_of_fast_dds() == of_dds


def test_namespaces_keep_two_apart(compose, observer):
    nodes = compose(namespace='oak', wind={}, anemometer={})
    nodes.add('wind', {}, namespace='elm')
    assert nodes['elm/wind'].get_namespace() == '/elm'
    oak = observer.listen(WIND_FILTERED, name='oak/wind/filtered')
    elm = observer.listen(WIND_FILTERED, name='elm/wind/filtered')
    observer.until(lambda: len(oak) > 5, 'wind for the oak')
    assert elm == []


def test_a_start_that_fails_cleans_up(domain):
    before = set(threading.enumerate())
    with pytest.raises(TreeSwayError, match='out of range'):
        Composition({'anemometer': {}, 'wind': {'max_speed': -1.0}}, domain_id=domain)
    assert set(threading.enumerate()) == before


def test_an_error_in_a_callback_ends_nothing_and_is_reported(domain, observer, level, monkeypatch):
    from tree_sway_ros.nodes import wind

    parts = Composition({'wind': {}, 'anemometer': {'rate': 50.0}}, domain_id=domain)
    filtered = observer.listen(WIND_FILTERED)
    with parts as nodes:
        observer.until(lambda: filtered, 'wind')
        good = wind.wind_from_message
        monkeypatch.setattr(wind, 'wind_from_message', lambda message: message.no_such_field)
        guard = nodes['wind'].guard
        observer.until(lambda: guard.count > 5, 'failures')
        observer.until(lambda: level('wind: callbacks') == WARN, 'a warning on /diagnostics')
        monkeypatch.setattr(wind, 'wind_from_message', good)
        n = len(filtered)
        observer.until(lambda: len(filtered) > n, 'wind again')
        nodes.check()


def test_a_clock_that_cannot_be_ends_nothing(compose, observer):
    nodes = compose(wind={'use_sim_time': True})
    clock = observer.publisher(CLOCK)
    tell = lambda second: clock.publish(Clock(clock=Time(sec=second)))  # noqa: E731
    observer.until(lambda: tell(-5) or nodes['wind'].guard.count, 'the failure')
    now = nodes['wind'].get_clock().now
    observer.until(lambda: tell(7) or now().nanoseconds == 7 * 10**9, 'the time')
    nodes['wind'].guard.count = 0  # seen; the fixture asks for none
