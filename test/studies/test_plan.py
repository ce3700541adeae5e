# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Study files: every combination once, and what is wrong with one is named."""

from __future__ import annotations

from pathlib import Path

import pytest

from tree_sway import kernel_cache
from tree_sway.errors import FormatError, ParameterError
from tree_sway.studies import plan
from tree_sway.studies.plan import read_study

LEAST = 'trees: [a]\nwinds: [{speed: 3}]\n'


@pytest.fixture
def study(tmp_path):
    def write(text):
        path = tmp_path / 'study.yaml'
        path.write_text(text, encoding='utf-8')
        return path

    return write


def test_every_tree_meets_every_wind_with_every_setting(study):
    cases = read_study(
        study("""
            trees: [goldcrest, {grow: {species: [oak, birch], height: [6, 8], seeds: 3}}]
            winds: [{speed: [3, 6, 9], seeds: 2}]
            settings: {model: 12, damping_ratio: [0.02, 0.05]}
            seconds: 5
        """)
    )
    assert len(cases) == (1 + 2 * 2 * 3) * 6 * 2
    assert len({case.name for case in cases}) == len(cases)
    assert cases[0].tree == {'name': 'goldcrest'}
    assert cases[0].settings == {'model': 12, 'damping_ratio': 0.02}
    assert {case.seconds for case in cases} == {5}


def test_a_case_is_named_after_the_content_of_what_it_reads(study, tmp_path):
    wind = tmp_path / 'wind.csv'
    path = study('trees: [goldcrest]\nwinds: [{file: wind.csv}]\n')
    names = set()
    for content in ('time,u,v\n0,1,0\n1,2,0\n', 'time,u,v\n0,1,0\n1,3,0\n'):
        wind.write_text(content, encoding='utf-8')
        names.add(read_study(path)[0].name)
    assert len(names) == 2
    assert read_study(path)[0].name in names


@pytest.mark.parametrize('name', ['core/growth/oak.py', 'files/trees/cylinders/qsm.py'])
def test_and_after_the_source_of_growth_and_of_readers(study, tmp_path, monkeypatch, name):
    """Whatever a case reads or grows by, imported by a module or by its name."""
    names = set()
    for text in ('', 'a', 'b'):
        root = tmp_path / f'copy{text}' / 'tree_sway'
        for path in ('studies/compute.py', name):
            (root / path).parent.mkdir(parents=True)
            for folder in Path(path).parents:
                (root / folder / '__init__.py').touch()
        (root / 'studies/compute.py').write_text('from tree_sway.core.growth import oak\n')
        (root / name).write_text(text)
        monkeypatch.setattr(plan, 'ROOT', root)
        monkeypatch.setattr(kernel_cache, 'ROOT', root)
        names.add(read_study(study('trees: [goldcrest]\nwinds: [{speed: 3}]'))[0].name)
    assert len(names) == 3


@pytest.mark.parametrize(
    ('text', 'kind', 'words'),
    [
        ('trees: [goldcrest]\n', FormatError, "has no 'winds'"),
        ('trees: []\nwinds: [{speed: 3}]', FormatError, 'trees'),
        ('trees: [a]\nwinds: [{speed: fast}]', FormatError, r'study\.yaml:2: winds\[0\]\.speed'),
        ('trees: [a]\nwinds: [{speed: 3}]\nseconds: 0', FormatError, r'study\.yaml:3: seconds'),
        ('trees: [a]\nwinds: [{speed: 3}]\nsettings: {wobble: 1}', ParameterError, "'wobble'"),
        (f'{LEAST}settings: {{model: [8, modes]}}', ParameterError, "unknown model 'modes'"),
        (f'{LEAST}settings: {{damping_ratio: strong}}', ParameterError, 'strong'),
        ('trees: [a]\nwinds: [{file: gone.csv}]', FormatError, r'gone\.csv'),
        ('trees: [a]\nwinds: [{seeds: 2}]', FormatError, 'a wind is a file or a speed'),
        ('trees: [', FormatError, r'study\.yaml:'),
    ],
)
def test_what_is_wrong_is_named(study, text, kind, words):
    with pytest.raises(kind, match=words):
        read_study(study(text))


def test_a_file_that_is_not_there_is_named(tmp_path):
    with pytest.raises(FormatError, match=r'none\.yaml'):
        read_study(tmp_path / 'none.yaml')
