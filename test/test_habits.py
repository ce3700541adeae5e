# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The order of the repository: its settings are files that their programs can read."""

from __future__ import annotations

import json
import os
from pathlib import Path
import re
import subprocess

import pytest
import yaml

import tree_sway  # noqa: I100

ROOT = Path(__file__).resolve().parent.parent
YAML = [
    *('.pre-commit-config.yaml', 'CITATION.cff', '.github/workflows/checks.yml'),
    *('.github/ISSUE_TEMPLATE/fault.yml', '.github/ISSUE_TEMPLATE/wish.yml'),
]


@pytest.mark.parametrize('name', YAML)
def test_it_is_yaml(name: str) -> None:
    assert isinstance(yaml.safe_load((ROOT / name).read_text(encoding='utf-8')), dict)


def test_nothing_lies_in_the_root_that_does_not_belong_there():
    """Every file there is one that a tool or a reader looks for by its name."""
    listed = subprocess.run(
        ['git', 'ls-files'], cwd=ROOT, capture_output=True, text=True, check=True
    ).stdout.split()
    found = {name for name in listed if '/' not in name and not name.startswith('.')}
    known = {'CHANGELOG.rst', 'CITATION.cff', 'CONTRIBUTING.md', 'Dockerfile', 'LICENSE'}
    known |= {'QUALITY_DECLARATION.md', 'README.md', 'conftest.py', 'package.xml'}
    assert found == known | {'pyproject.toml', 'setup.cfg', 'setup.py'}


def test_the_citation_names_this_version() -> None:
    citation = yaml.safe_load((ROOT / 'CITATION.cff').read_text(encoding='utf-8'))
    assert citation['version'] == tree_sway.__version__
    assert citation['license'] == 'Apache-2.0'
    preferred = citation['preferred-citation']
    assert preferred['version'] == tree_sway.__version__
    assert preferred['year'] >= 2026
    assert preferred['authors'][0]['email'] == citation['authors'][0]['email']
    assert {name['family-names'] for name in citation['references'][0]['authors']} == {
        *('Kanda', 'Ohya'),
    }


def test_the_container_for_editors_is_described() -> None:
    described = json.loads((ROOT / '.devcontainer/devcontainer.json').read_text(encoding='utf-8'))
    assert '.ci/in_venv.py' in described['postCreateCommand']


def test_what_the_workflow_runs_is_there() -> None:
    jobs = yaml.safe_load((ROOT / YAML[2]).read_text(encoding='utf-8'))['jobs']
    assert jobs['test']['strategy']['matrix']['python'] == [f'3.{k}' for k in range(10, 15)]
    assert jobs['jazzy']['container'] == 'ros:jazzy'
    assert jobs['bounds']['env'] == {'NUMBA_BOUNDSCHECK': '1'}
    commands = [step['run'] for job in jobs.values() for step in job['steps'] if 'run' in step]
    for path in re.findall(
        r'(?<![\w/])(?:test|lab|\.ci|tree_sway|tree_sway_ros)/[\w./]+', ' '.join(commands)
    ):
        assert (ROOT / path).exists(), path


def test_scripts_can_be_run_and_are_sound_shell() -> None:
    script = ROOT / '.ci' / 'run'
    assert os.access(script, os.X_OK)
    assert subprocess.run(['bash', '-n', str(script)], check=False).returncode == 0


def test_every_source_file_says_whose_it_is_and_under_which_licence() -> None:
    sources = [ROOT / 'setup.py', ROOT / '.ci' / 'in_venv.py', ROOT / '.ci' / 'run']
    for folder in ('tree_sway', 'tree_sway_ros', 'lab', 'test', 'launch'):
        for suffix in ('py', 'js', 'css', 'html'):
            sources += [p for p in (ROOT / folder).rglob(f'*.{suffix}') if 'data' not in p.parts]
    silent = [
        str(path.relative_to(ROOT))
        for path in sources
        if 'SPDX-License-Identifier: Apache-2.0' not in path.read_text(encoding='utf-8')[:400]
    ]
    assert len(sources) > 500
    assert not silent, 'put the two lines of setup.py at the top of: ' + ', '.join(silent)
