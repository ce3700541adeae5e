# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Study files: every combination once, and what is wrong with one is named."""

from __future__ import annotations

from pathlib import Path
import tracemalloc

import pytest

from tree_sway.cache import source
from tree_sway.errors import FormatError, ParameterError, SpeciesError
from tree_sway.forest import plan
from tree_sway.forest.compute import _wind
from tree_sway.forest.plan import read_study

ONE = 'trees: [goldcrest]\n'
WINDS = 'winds:\n- {speed: 3}\n'
LEAST = ONE + WINDS
GROWN = 'trees:\n  - grow: {species: '


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


@pytest.mark.parametrize('name', ['growth/oak.py', 'files/trees/cylinders/qsm.py'])
def test_and_after_the_source_of_growth_and_of_readers(study, tmp_path, monkeypatch, name):
    """Whatever a case reads or grows by, imported by a module or by its name."""
    names = set()
    for text in ('', 'a', 'b'):
        root = tmp_path / f'copy{text}' / 'tree_sway'
        for path in ('forest/compute.py', name):
            (root / path).parent.mkdir(parents=True)
            for folder in Path(path).parents:
                (root / folder / '__init__.py').touch()
        (root / 'forest/compute.py').write_text('from tree_sway.growth import oak\n')
        (root / name).write_text(text)
        monkeypatch.setattr(plan, 'ROOT', root)
        monkeypatch.setattr(source, 'ROOT', root)
        names.add(read_study(study('trees: [goldcrest]\nwinds: [{speed: 3}]'))[0].name)
    assert len(names) == 3


@pytest.mark.parametrize(
    ('text', 'kind', 'words'),
    [
        ('trees: [goldcrest]\n', FormatError, "has no 'winds'"),
        ('trees: []\nwinds: [{speed: 3}]', FormatError, 'trees'),
        (f'{ONE}winds: [{{speed: fast}}]', FormatError, r'study\.yaml:2: winds\[0\]\.speed'),
        (f'{ONE}winds: [{{speed: 3}}]\nseconds: 0', FormatError, r'study\.yaml:3: seconds'),
        (f'{ONE}winds: [{{speed: 3}}]\nsettings: {{wobble: 1}}', ParameterError, "'wobble'"),
        (f'{LEAST}settings: {{model: [8, modes]}}', ParameterError, "unknown model 'modes'"),
        (f'{LEAST}settings: {{damping_ratio: strong}}', ParameterError, 'strong'),
        (f'{ONE}winds: [{{file: gone.csv}}]', FormatError, r'gone\.csv'),
        (f'{ONE}winds: [{{seeds: 2}}]', FormatError, 'a wind is a file or a speed'),
        (f'trees: [{{}}]\n{WINDS}', FormatError, 'yaml:1: a tree is a file or grown; give one of'),
        (f'trees: [{{file: goldcrst}}]\n{WINDS}', FormatError, "mean 'goldcrest'"),
        ('trees: [', FormatError, r'study\.yaml:'),
        (f'{ONE}winds: [{{speed: 3, intensity: true}}]', FormatError, "intensity is 'true'"),
        (f'{LEAST}settings: {{model: {"9" * 5000}}}', ParameterError, "unknown model '999"),
        (f'{LEAST}seconds: {"9" * 5000}', FormatError, "seconds is '999"),
        (f'{ONE}winds: [{{file: "~nosuchuser/wind.csv"}}]', FormatError, 'no user'),
        (f'trees: [{"a" * 300}]\nwinds: [{{speed: 3}}]', FormatError, 'File name too long'),
        ('', FormatError, r'study\.yaml: empty; describe trees and winds in it'),
        ('trees: [\ngoldcrst]\nwinds: [{speed: 3}]', FormatError, "yaml:2: .*mean 'goldcrest'"),
        (f'winds: [{{speed: 3}}]\n{GROWN}okk, height: 5}}', SpeciesError, "yaml:3: .*mean 'oak'"),
        (f'winds: [{{speed: 3}}]\n{GROWN}oak, height: 0}}', ParameterError, 'yaml:3: height: '),
        (f'{LEAST}- {{speed: [3, -3]}}', ParameterError, r'yaml:4: mean_speed: -3\.0 is out'),
        (f'{LEAST}- {{speed: 3, intensity: 40}}', ParameterError, r'yaml:4: intensity: 40\.0 is'),
        (f'{LEAST}- {{file: canopy, scale: [1, -1]}}', FormatError, r"scale\[1\] is '-1'; give"),
        (f'{LEAST}rate: 1001', FormatError, "rate is '1001'"),
        (f'{LEAST}seconds: 86400\nrate: 1000', ParameterError, 'are 8.64e\\+07 steps; give at'),
    ],
)
def test_what_is_wrong_is_named(study, text, kind, words):
    with pytest.raises(kind, match=words):
        read_study(study(text))


@pytest.mark.parametrize(
    'text',
    [
        'trees: [{grow: {species: oak, height: [4, 8], seeds: 100000}}]\nwinds: [{speed: 3}]\n',
        'trees: [goldcrest]\nwinds: [{speed: [3, 4], intensity: [0.1, 0.2], seeds: 100000}]\n',
        LEAST + 'settings:\n' + ''.join(
            f'  {name}: [{", ".join(f"{0.01 * k:.2f}" for k in range(1, 25))}]\n'
            for name in ('damping_ratio', 'crown_coherence', 'gravity', 'stiffness_factor')
        ),
    ],
)  # fmt: skip
def test_a_small_file_of_a_huge_study_is_refused_before_any_work(study, text):
    path = study(text)
    assert path.stat().st_size < 2000
    tracemalloc.start()
    with pytest.raises(FormatError, match=r'are \d+ cases; give at most 100000 cases'):
        read_study(path)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 10e6


def test_the_built_in_wind_is_one_of_a_study(study, tmp_path):
    path = study('trees: [goldcrest]\nwinds: [{file: canopy, scale: [1, 2]}]\nseconds: 1\n')
    assert [case.wind for case in read_study(path)] == [
        {'file': 'canopy', 'scale': 1.0}, {'file': 'canopy', 'scale': 2.0},
    ]  # fmt: skip
    once, twice = (_wind(case) for case in read_study(path))
    assert (twice.velocity == 2.0 * once.velocity).all()
    (tmp_path / 'canopy').write_text('time,u,v\n0,1,0\n1,2,0\n', encoding='utf-8')
    assert [case.wind['file'] for case in read_study(path)] == [str(tmp_path / 'canopy')] * 2


def test_a_tree_of_a_file_can_be_written_as_a_wind_of_one(study, tmp_path):
    (tmp_path / 'own.yaml').write_text('segments: []\n', encoding='utf-8')
    short = read_study(study(f'trees: [own.yaml, goldcrest]\n{WINDS}'))
    long = read_study(study(f'trees: [{{file: own.yaml}}, {{file: goldcrest}}]\n{WINDS}'))
    assert short == long
    assert long[0].tree == {'file': str(tmp_path / 'own.yaml')}


def test_a_file_that_is_not_there_is_named(tmp_path):
    with pytest.raises(FormatError, match=r'none\.yaml'):
        read_study(tmp_path / 'none.yaml')
