# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The file of a tree that keeps what motion sensors tell about it, over several runs."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from tree_sway.commands.cli import main
from tree_sway.errors import FormatError, TreeSwayError
from tree_sway.files.export.tree_export import write_tree
from tree_sway.files.trees.learned_file import LearnedFile
from tree_sway.files.trees.source import open_tree
from tree_sway.twin.learned_tree import LearnedTree
from tree_sway.twin.observed_tree import ObservedTree
from tree_sway.twin.tree_fit import TreeFit

SEEDLING = Path(__file__).parents[1] / 'data' / 'seedling.yaml'
ONCE = LearnedTree(
    frequency=1.0, stiffness=0.8, stiffness_error=0.03, damping=1.5, damping_error=0.2,
    drag=0.9, drag_error=0.2, hours=1.0,
)  # fmt: skip


def test_what_was_learned_twice_is_weighted_by_hours() -> None:
    # The second run begins with the tree of the first: it is softer by a tenth, seen for 3 h.
    second = replace(ONCE, frequency=0.9, stiffness=0.9, damping=1.0, drag=1.0, hours=3.0)
    both = second.after(ONCE)
    assert both.hours == 4.0
    assert both.stiffness == pytest.approx(0.8 * 0.9**0.75)
    assert both.damping == pytest.approx(1.5)
    assert both.frequency == pytest.approx(0.9**0.75)
    assert both.stiffness_error == pytest.approx(0.03 * (0.75**2 + 0.25**2) ** 0.5)
    assert both.drag_error == pytest.approx(0.2)
    assert second.after(None) is second


def test_many_runs_do_not_carry_a_tree_away() -> None:
    found = ONCE
    for _ in range(30):
        found = replace(ONCE, stiffness=0.5, hours=1000.0).after(found)
    assert 0.3 < found.stiffness < 0.5


def learned_by(twin: ObservedTree, monkeypatch: pytest.MonkeyPatch, stiffness: float) -> None:
    """Let a tree learn a stiffness in an hour."""
    fit = TreeFit(stiffness, 1.2, 0.02, 0.2, 0.9, 0.2, 1.0)
    monkeypatch.setattr(twin.observer._fit, 'found', fit)


def test_a_second_run_goes_on_from_the_first(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    opened, path = open_tree(SEEDLING), str(tmp_path / 'own.twin.yaml')
    for run, modulus in ((1, 0.8), (2, 0.8 * 0.9**0.5)):
        file = LearnedFile(path, opened, in_leaf=False)
        twin = ObservedTree(file.opened, in_leaf=False, at={'phone': 'segment:3'})
        assert not file.keep(twin)
        learned_by(twin, monkeypatch, 0.8 if run == 1 else 0.9)
        assert file.keep(twin)
        assert not file.keep(twin)
        again = open_tree(path)
        assert again.species.modulus / opened.species.modulus == pytest.approx(modulus)
        assert again.learned is not None
        assert again.learned.hours == pytest.approx(run)
        assert again.learned.stiffness == pytest.approx(modulus)
        assert f'{run} h of motion' in again.notes[-1]
    # The tree of the file itself goes on as well.
    assert LearnedFile(path, open_tree(path)).opened.learned == again.learned


def test_a_change_of_the_sway_is_in_the_file(tmp_path: Path) -> None:
    opened, path = open_tree(SEEDLING), tmp_path / 'own.yaml'
    LearnedFile(str(path), opened).write(replace(ONCE, change='it sways differently: +9 %'))
    again = open_tree(str(path))
    assert again.notes[-1].endswith('; it sways differently: +9 %')
    assert again.learned is not None
    assert replace(ONCE, hours=2.0).after(again.learned).change == 'it sways differently: +9 %'


def test_a_file_that_would_be_lost_is_refused(tmp_path: Path) -> None:
    opened, path = open_tree(SEEDLING), tmp_path / 'own.yaml'
    LearnedFile(str(path), opened).write(ONCE)
    with pytest.raises(FormatError, match='of another tree than'):
        LearnedFile(str(path), open_tree('broadleaf'))
    text = path.read_text(encoding='utf-8')
    begin, end = text.index('learned:'), text.index('branches:')
    path.write_text(text[:begin] + text[end:], encoding='utf-8')
    with pytest.raises(FormatError, match='nothing was learned, and would be replaced'):
        LearnedFile(str(path), opened)
    path.write_text('name: [', encoding='utf-8')
    with pytest.raises(FormatError, match=r'own\.yaml'):
        LearnedFile(str(path), opened)
    with pytest.raises(FormatError, match=r'write a \.yaml file'):
        LearnedFile(str(tmp_path / 'own.glb'), opened)
    with pytest.raises(FormatError, match='no such folder'):
        LearnedFile(str(tmp_path / 'none' / 'own.yaml'), opened)


def test_what_another_program_learned_meanwhile_stays(tmp_path: Path) -> None:
    opened, path = open_tree(SEEDLING), tmp_path / 'own.yaml'
    ours, theirs = LearnedFile(str(path), opened), LearnedFile(str(path), opened)
    theirs.write(replace(ONCE, hours=9.0))
    kept = path.read_text(encoding='utf-8')
    with pytest.raises(FormatError, match='was written by another program meanwhile'):
        ours.write(ONCE)
    assert path.read_text(encoding='utf-8') == kept
    theirs.write(replace(ONCE, hours=10.0))
    path.unlink()
    ours.write(ONCE)
    assert path.is_file()


def test_what_was_learned_outlives_a_conversion(tmp_path: Path) -> None:
    path, again = str(tmp_path / 'own.yaml'), str(tmp_path / 'again.yaml')
    LearnedFile(path, open_tree(SEEDLING)).write(ONCE)
    assert main(['convert', path, '-o', again, '-q']) == 0
    assert open_tree(again).learned == open_tree(path).learned
    write_tree(again, open_tree(path))
    assert open_tree(again).learned == open_tree(path).learned
    # Of another wood nothing was learned.
    assert main(['convert', path, '-o', again, '--force', '-q', '--modulus', '5e9']) == 0
    assert open_tree(again).learned is None


@pytest.mark.usefixtures('little_effort')
@pytest.mark.parametrize(
    ('old', 'new'),
    [
        (b'modulus: ', b'modulus: 1e7'),
        (b'stiffness: 0.8', b'stiffness: 1e17'),
        (b'stiffness: 0.8', b'stiffness: .nan'),
        (b'frequency: 1.0', b'frequency: 1e300'),
        (b'hours: 1.0', b'hours: many'),
        (b'learned: {', b'learned: ['),
        (b'name', b'na\x00me'),
        (b'name', b'na\xffme'),
        (b'branches', b''),
    ],
)
def test_a_damaged_file_is_refused_by_its_name_with_a_cure(
    tmp_path: Path, old: bytes, new: bytes
) -> None:
    opened = open_tree(SEEDLING)
    path = tmp_path / 'own.twin.yaml'
    LearnedFile(str(path), opened).write(ONCE)
    content = path.read_bytes()
    assert old in content
    path.write_bytes(content.replace(old, new, 1))
    with pytest.raises(TreeSwayError, match=r'own\.twin\.yaml') as refused:
        LearnedFile(str(path), opened)
    assert refused.value.cure


@pytest.mark.usefixtures('little_effort')
def test_a_huge_file_is_refused_before_it_is_read(tmp_path: Path) -> None:
    path = tmp_path / 'own.twin.yaml'
    with path.open('wb') as file:
        file.truncate(2**33)
    with pytest.raises(FormatError, match=r'own\.twin\.yaml: larger than'):
        LearnedFile(str(path), open_tree(SEEDLING))
