# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What a release and its users rely on outside the code: version, licence, workflow."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path
import re

import pytest
import yaml

import tree_sway  # noqa: I100

ROOT = Path(__file__).resolve().parent.parent
PACKAGES = (ROOT / 'tree_sway', ROOT / 'tree_sway_ros', ROOT / 'lab' / 'tree_sway_lab')
WORKFLOWS = sorted((ROOT / '.github' / 'workflows').glob('*.yml'))


def test_the_citation_names_this_version() -> None:
    citation = yaml.safe_load((ROOT / 'CITATION.cff').read_text(encoding='utf-8'))
    assert citation['version'] == tree_sway.__version__
    assert citation['license'] == 'Apache-2.0'
    assert citation['preferred-citation']['version'] == tree_sway.__version__


@pytest.mark.parametrize('workflow', WORKFLOWS, ids=lambda path: path.name)
def test_every_path_that_a_workflow_runs_exists(workflow: Path) -> None:
    jobs = yaml.safe_load(workflow.read_text(encoding='utf-8'))['jobs']
    commands = [step['run'] for job in jobs.values() for step in job['steps'] if 'run' in step]
    paths = re.findall(
        r'(?<![\w/])(?:test|lab|\.ci|tree_sway|tree_sway_ros)/[\w./]+', ' '.join(commands)
    )
    assert paths
    assert not [path for path in paths if not (ROOT / path).exists()]


def test_every_source_file_has_the_licence_in_its_header() -> None:
    sources = [ROOT / 'setup.py', *(ROOT / '.ci').glob('*.py'), ROOT / '.ci' / 'run']
    for folder in ('tree_sway', 'tree_sway_ros', 'lab', 'test', 'launch'):
        for suffix in ('py', 'js', 'css', 'html'):
            sources += [p for p in (ROOT / folder).rglob(f'*.{suffix}') if 'data' not in p.parts]
    without = [
        str(path.relative_to(ROOT))
        for path in sources
        if 'SPDX-License-Identifier: Apache-2.0' not in path.read_text(encoding='utf-8')[:400]
    ]
    assert not without, 'put the two lines of setup.py at the top of: ' + ', '.join(without)


def names_in(tree: ast.AST) -> Iterator[str]:
    """Names that a module defines or uses, and words of its texts that are no docstrings."""
    for node in ast.walk(tree):
        for field in ('name', 'id', 'attr', 'arg'):
            name = getattr(node, field, None)
            if isinstance(name, str):
                yield name
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            if '`' not in node.value:
                yield from re.findall(r'\w+', node.value)


def test_names_in_docstrings_exist() -> None:
    """One pair of backticks is for names of this package; others have two."""
    paths = [path for folder in PACKAGES for path in folder.rglob('*.py')]
    trees = {path: ast.parse(path.read_text(encoding='utf-8')) for path in paths}
    known = {part for path in paths for part in path.with_suffix('').parts}
    known |= {path.name for folder in PACKAGES for path in folder.rglob('*') if path.is_file()}
    for tree in trees.values():
        known.update(names_in(tree))
    unknown = []
    for path, tree in trees.items():
        for node in ast.walk(tree):
            if not isinstance(node, ast.Expr) or not isinstance(node.value, ast.Constant):
                continue
            quoted = re.findall(r'(?<!`)`([\w.]+)`(?!`)', str(node.value.value))
            for name in quoted:
                if name not in known and not set(name.split('.')) <= known:
                    unknown.append(f'{path.relative_to(ROOT)}:{node.lineno}: {name}')
    assert not unknown, 'no such name: ' + ', '.join(unknown)
