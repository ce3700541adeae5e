# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Models of further packages: used where they are installed, else with what to install."""

from __future__ import annotations

from importlib.metadata import EntryPoint
from pathlib import Path
import re

import numpy as np
import pytest

from tree_sway import installed_models as module
from tree_sway.commands.cli import main
from tree_sway.core.run.rigid import RigidBank
from tree_sway.core.scene.make import make_simulator
from tree_sway.core.settings import MODELS, OF_LAB, Settings
from tree_sway.errors import MissingDependencyError, ParameterError
from tree_sway.installed_models import GROUP, installed_models
from tree_sway.parameters.sway_parameters import SWAY

ROOT = Path(__file__).resolve().parents[1]


@pytest.fixture
def installed(monkeypatch: pytest.MonkeyPatch) -> dict[str, EntryPoint]:
    """Replace the installed models, none at first, for a test."""
    points: dict[str, EntryPoint] = {}
    monkeypatch.setattr(module, 'installed_models', lambda: points)
    return points


def mine(model, branches):
    """Make a model of this file: a tree that does not move."""
    return RigidBank(model)


@pytest.mark.parametrize('model', OF_LAB)
def test_a_model_of_the_laboratory_says_what_to_install(installed, model) -> None:
    cure = r'pip install \./lab|in_venv\.py'
    with pytest.raises(MissingDependencyError, match=f"'{model}' belongs to the lab.*({cure})"):
        Settings(model=model)


def test_a_laboratory_without_its_entry_points_is_to_be_installed_again(installed, monkeypatch):
    for found, words in ((None, 'is not installed; install it: '), (object(), 'install it again')):
        monkeypatch.setattr(module, 'find_spec', {module.LABORATORY: found}.get)
        with pytest.raises(MissingDependencyError, match=words):
            Settings(model='full')


def test_a_command_says_it_on_one_line(installed, capsys) -> None:
    assert main(['simulate', 'goldcrest', '--model', 'full', '-o', 'never.csv']) == 2
    said = capsys.readouterr().err
    assert said.count('\n') == 1
    assert "model 'full' belongs to the laboratory" in said


def test_the_laboratory_names_an_object_that_makes_the_model(fork) -> None:
    text = (ROOT / 'lab' / 'pyproject.toml').read_text(encoding='utf-8')
    section = re.search(rf'\[project\.entry-points\."{re.escape(GROUP)}"\]\n((?:.+\n)+)', text)
    assert section is not None
    found = dict(re.findall(r'^(\w+) = "(.+)"$', section[1], re.MULTILINE))
    assert {*found} == {*OF_LAB}
    for name, value in found.items():
        assert EntryPoint(name, value, GROUP).load() == installed_models()[name].load()
        assert make_simulator(fork(), model=name, cache=None).model == name


def test_a_model_of_another_package_is_made_by_its_own_function(installed, fork) -> None:
    installed['mine'] = type('Point', (), {'load': staticmethod(lambda: mine)})()
    sim = make_simulator(fork(), model='mine', cache=None)
    other = make_simulator(fork(), model=0, cache=None)
    for one in (sim, other):
        one.step((6.0, 1.0, 0.0), 1 / 60)
    assert sim.model == 'mine'
    assert sim.place().tobytes() == other.place().tobytes()


def test_rotations_of_another_number_are_refused_before_they_are_read(installed, fork) -> None:
    class Short(RigidBank):
        def rotations(self):
            return np.zeros(1)

    def make(model, branches):
        return Short(model)

    installed['short'] = type('Point', (), {'load': staticmethod(lambda: make)})()
    sim = make_simulator(fork(), model='short', cache=None)
    with pytest.raises(ValueError, match=r'an array of shape \(1,\) where'):
        sim.place()


def test_an_unknown_model_is_refused_with_those_that_there_are(installed) -> None:
    with pytest.raises(ParameterError, match="unknown model 'mine'"):
        Settings(model='mine')
    installed['mine'] = None
    with pytest.raises(ParameterError, match=r"'mien'; did you mean 'mine'.* one of: .*mine"):
        Settings(model='mien')


@pytest.mark.parametrize(
    ('value', 'why'),
    [
        ('no_such_package.bank:make', 'ModuleNotFoundError: .*no_such_package'),
        ('tree_sway.errors:no_such_name', 'AttributeError: .*no_such_name'),
    ],
)
def test_a_model_that_cannot_be_loaded_is_named_with_the_cure(
    installed, capsys, value, why
) -> None:
    installed['mine'] = EntryPoint('mine', value, GROUP)
    assert main(['simulate', 'goldcrest', '--model', 'mine', '-o', 'never.csv']) == 2
    said = capsys.readouterr().err
    assert re.search(f"'mine' of its package cannot be loaded \\({why}.*uninstall it$", said)
    assert 'Traceback' not in said


def test_the_parameter_takes_an_installed_model(monkeypatch) -> None:
    parameter = SWAY['model']
    assert {*MODELS} == {*parameter.choices}
    with pytest.raises(ParameterError, match="'mine' is not among its choices"):
        parameter.checked('mine')
    monkeypatch.setattr(module, 'installed_models', lambda: {'mine': None})
    assert parameter.checked('mine') == 'mine'
