# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The launch file of the tutorial starts nodes that there are, with parameters that they take."""

from __future__ import annotations

from pathlib import Path
import re
import sys
from types import ModuleType, SimpleNamespace
from typing import Any

import pytest

from tree_sway_ros.nodes import executables
from tree_sway_ros.parameters.node_parameters import NODE_PARAMETERS

PAGE = Path(__file__).resolve().parents[2] / 'doc' / 'tutorials' / 'launch_file.md'


def module(name: str, **members: Any) -> ModuleType:
    made = ModuleType(name)
    vars(made).update(members)
    return made


def test_its_nodes_and_parameters_are_ours(monkeypatch: pytest.MonkeyPatch) -> None:
    """With launch's classes replaced by records, as launch is no dependency of the tests."""
    record = lambda **words: SimpleNamespace(**words)  # noqa: E731
    monkeypatch.setitem(sys.modules, 'launch', module('launch', LaunchDescription=list))
    monkeypatch.setitem(sys.modules, 'launch_ros', module('launch_ros'))
    actions = module('launch_ros.actions', Node=record)
    monkeypatch.setitem(sys.modules, 'launch_ros.actions', actions)
    (text,) = re.findall(r'^```py\n(.*?)^```$', PAGE.read_text(), re.MULTILINE | re.DOTALL)
    file: dict[str, Any] = {}
    exec(compile(text, PAGE.name, 'exec'), file)
    nodes = file['generate_launch_description']()
    assert [node.executable for node in nodes] == ['wind', 'solver']
    assert len({node.namespace for node in nodes}) == 1
    for node in nodes:
        assert node.package == 'tree_sway_ros'
        assert callable(getattr(executables, node.executable))
        known = {each.name: each for each in NODE_PARAMETERS[node.executable]}
        for name, value in node.parameters[0].items():
            assert known[name].checked(value) == value
