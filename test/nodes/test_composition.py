import threading

import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not installed")
pytestmark = pytest.mark.ros

from tree_sway_ros.errors import TreeSwayError  # noqa: E402
from tree_sway_ros.ros.process.composition import Composition  # noqa: E402
from tree_sway_ros.ros.process.topics import WIND_FILTERED  # noqa: E402


def test_it_closes_twice_and_leaves_no_thread(domain):
    before = set(threading.enumerate())
    with Composition({"wind": {}, "anemometer": {}}, domain_id=domain) as nodes:
        assert nodes["wind"].get_name() == "wind"
        nodes.check()
        assert not nodes.is_done
    nodes.close()
    assert set(threading.enumerate()) == before


def test_namespaces_keep_two_apart(compose, observer):
    nodes = compose(namespace="oak", wind={}, anemometer={})
    nodes.add("wind", {}, namespace="elm")
    assert nodes["elm/wind"].get_namespace() == "/elm"
    oak = observer.listen(WIND_FILTERED, name="oak/wind/filtered")
    elm = observer.listen(WIND_FILTERED, name="elm/wind/filtered")
    observer.until(lambda: len(oak) > 5, "wind for the oak")
    assert elm == []


def test_a_start_that_fails_cleans_up(domain):
    before = set(threading.enumerate())
    with pytest.raises(TreeSwayError, match="out of range"):
        Composition({"anemometer": {}, "wind": {"max_speed": -1.0}}, domain_id=domain)
    assert set(threading.enumerate()) == before


def test_an_error_in_a_callback_is_told(domain, monkeypatch):
    from tree_sway_ros.nodes import wind

    happened = threading.Event()

    def fail(_message):
        happened.set()
        raise ValueError("a bug")

    monkeypatch.setattr(wind, "wind_from_message", fail)
    with Composition({"wind": {}, "anemometer": {"rate": 50.0}}, domain_id=domain) as nodes:
        assert happened.wait(10.0)
        nodes._thread.join(10.0)
        with pytest.raises(ValueError, match="a bug"):
            nodes.check()
