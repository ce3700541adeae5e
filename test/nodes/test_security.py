# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The policy for SROS2 names what the nodes say and hear."""

from pathlib import Path
from xml.etree import ElementTree

import pytest

from tree_sway_ros.ros.parameters.node_parameters import NODE_PARAMETERS
from tree_sway_ros.ros.process.topics import TOPICS

POLICY = ElementTree.parse(Path(__file__).parents[2] / "config" / "sros2_policy.xml").getroot()


def test_every_node_has_an_enclave():
    assert {each.get("node") for each in POLICY.iter("profile")} == set(NODE_PARAMETERS)
    paths = {each.get("path") for each in POLICY.iter("enclave")}
    assert paths == {f"/tree_sway/{name}" for name in NODE_PARAMETERS}


def test_every_topic_may_be_said_by_somebody():
    allowed = {
        topic.text for topics in POLICY.iter("topics") if topics.get("publish") for topic in topics
    }
    assert {topic.name for topic in TOPICS} - allowed == {"camera", "/tf_static"}  # of others


@pytest.mark.ros
def test_what_nodes_say_and_hear_is_allowed(compose, tree_file):
    pytest.importorskip("rclpy", reason="ROS 2 is not installed")
    parameters = {"solver": {"tree": tree_file}, "wind": {}, "anemometer": {}, "sensor": {}}
    parameters["player"] = {
        "file": "canopy",
        "publish_clock": True,
        "wait_for": "wind/filtered nobody",
    }
    for node in compose(**parameters).nodes:
        profile = next(p for p in POLICY.iter("profile") if p.get("node") == node.get_name())
        for way, made in (("publish", node.publishers), ("subscribe", node.subscriptions)):
            allowed = {t.text for topics in profile if topics.get(way) for t in topics}
            names = {each.topic_name for each in made}
            assert names <= {f"/{name.lstrip('/')}" for name in allowed}, (node.get_name(), way)
