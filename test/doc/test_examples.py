# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The examples run as they are, and say what they promise."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
import re
import runpy
import sys

import pytest

from tree_sway.forest.plan import read_study

ROOT = Path(__file__).resolve().parents[2]
SEEDLING = ROOT / 'test' / 'files' / 'data' / 'seedling.yaml'
SCRIPTS = sorted((ROOT / 'examples').glob('*.py'))


@pytest.fixture
def output_of(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> Callable[..., str]:
    """Run an example with words behind its name, and return what it prints."""
    pytest.importorskip('matplotlib', reason='needs matplotlib')

    def run(name: str, *words: str) -> str:
        path = str(ROOT / 'examples' / name)
        monkeypatch.setattr(sys, 'argv', [path, *words])
        monkeypatch.chdir(tmp_path)
        runpy.run_path(path, run_name='__main__')
        return capsys.readouterr().out

    return run


def test_every_example_is_tried_here() -> None:
    tried = {'critical_wind_speed', 'response_spectra', 'sheltered_and_open'}
    assert {script.stem for script in SCRIPTS} == tried


def test_a_tree_sways_most_at_its_own_frequency(
    tmp_path: Path, output_of: Callable[..., str]
) -> None:
    from tree_sway import make_simulator, open_tree, write_tree

    tree = open_tree(SEEDLING, length_unit=2.0)
    write_tree(tmp_path / 'tall.yaml', tree)
    slowest = make_simulator(tree).frequencies(1)[0]
    text = output_of('response_spectra.py', 'tall.yaml', 'spectra.png')
    found = re.search(r'sways most at ([\d.]+) Hz, (\d+) times', text)
    assert found
    assert float(found[1]) == pytest.approx(slowest, rel=0.2)
    assert float(found[2]) > 2
    assert (tmp_path / 'spectra.png').read_bytes().startswith(b'\x89PNG')


def test_strain_grows_with_the_wind_up_to_the_critical_one(output_of: Callable[..., str]) -> None:
    text = output_of('critical_wind_speed.py', str(SEEDLING))
    strains = [float(each) for each in re.findall(r'strain +([\d.]+) permille', text)]
    assert len(strains) == 5
    assert strains == sorted(strains)
    power = re.search(r'to the power ([\d.]+);', text)
    assert power
    assert 1.0 < float(power[1]) < 2.2


def test_shelter_relieves_the_base(output_of: Callable[..., str]) -> None:
    text = output_of('sheltered_and_open.py')
    rows = dict(re.findall(r'^(\w+) +tip .*base moment ([\d.]+)', text, re.MULTILINE))
    assert 0.0 < float(rows['sheltered']) < 0.9 * float(rows['open'])


def test_the_study_of_a_thousand_cases_is_one() -> None:
    cases = read_study(ROOT / 'config' / 'examples' / 'grown_trees.yaml')
    assert len(cases) == 100 * 10
    assert len({str(case.tree) for case in cases}) == 100
    assert {case.seconds for case in cases} == {60}
