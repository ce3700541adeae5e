# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``tree-sway calibrate``: from a measured sway to a tree that sways so."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tree_sway.commands import cli
from tree_sway.core.run.simulator import SwaySimulator
from tree_sway.core.scene.make import make_simulator
from tree_sway.files.trees.source import open_tree

TREE = """
name: young ash
species: ash
wood: {modulus: 7.0e+9, damping_ratio: .06}
branches:
  - name: stem
    nodes: [[0, 0, 0, .05], [0, 0, 1, .04], [.02, .01, 2, .03], [.05, 0, 3.5, .01]]
  - {name: low, parent: stem, at: .4, nodes: [[0, 0, 0, .015], [.6, .2, .5, .006]]}
  - {name: high, parent: stem, at: .6, nodes: [[0, 0, 0, .012], [-.4, .3, .5, .005]]}
"""
DT = 0.02


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    """Make the tree that is measured."""
    path = tmp_path / 'ash.yaml'
    path.write_text(TREE)
    return path


def info(path: Path, capsys: pytest.CaptureFixture[str], *more: str) -> dict[str, Any]:
    """Return what ``tree-sway info`` says of a tree."""
    capsys.readouterr()
    assert cli.main(['info', str(path), '--json', *more]) == 0
    facts: dict[str, Any] = json.loads(capsys.readouterr().out)
    return facts


def record(path: Path, sim: SwaySimulator, winds: np.ndarray, dt: float, pulled: int = 0) -> None:
    """Sway of the tip as a file: what comes after `pulled` steps."""
    rows = ['time [s],x [mm],y [mm]']
    for step, wind in enumerate(winds):
        sim.step(wind, dt)
        sim.place()
        if step >= pulled:
            x, y, _ = 1e3 * sim.tip_displacement
            rows.append(f'{step * dt:.3f},{x:.6g},{y:.6g}')
    path.write_text('\n'.join(rows) + '\n')


@pytest.mark.parametrize('leaves', ['off', 'on'])
def test_info_shows_the_frequency_that_was_given(
    tree: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], leaves: str
) -> None:
    out = tmp_path / 'fitted.yaml'
    command = [
        'calibrate',
        str(tree),
        '--frequency',
        '1.2',
        '--damping',
        '0.09',
        '--leaves',
        leaves,
    ]
    assert cli.main([*command, '-o', str(out)]) == 0
    text = capsys.readouterr().out
    assert "-> 1.2 Hz (back and forth in 0.833 s), most in branch 'stem'" in text
    assert f'damping    0.06 -> 0.09 {"in leaf" if leaves == "on" else "bare"}' in text
    assert 'in wide swings it is too high, as air brakes too' in text
    assert text.splitlines()[-1].startswith(f'Next: tree-sway show {out}')
    facts = info(out, capsys, '--leaves', leaves)
    assert facts['frequencies'][0] == pytest.approx(1.2, rel=1e-6)
    assert facts['modes'][0]['damping_ratio'] == pytest.approx(0.09)
    other = info(out, capsys, '--leaves', 'off' if leaves == 'on' else 'on')
    assert other['modes'][0]['damping_ratio'] == pytest.approx(0.06)


def test_a_pull_and_release_gives_the_tree_back(
    tree: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A wind holds the tree aside and stops; the record leads from another guess to its wood."""
    truth = open_tree(tree)
    sim = make_simulator(truth.tree, truth.species, model=12)
    pulled, free = round(15.0 / DT), round(20.0 / DT)
    winds = np.repeat([[4.0, 1.5, 0.0], [0.0, 0.0, 0.0]], [pulled, free], axis=0)
    record(tmp_path / 'pull.csv', sim, winds, DT, pulled=pulled - 150)
    out = tmp_path / 'fitted.yaml'
    command = ['calibrate', str(tree), '--modulus', '2e10', '--record', str(tmp_path / 'pull.csv')]
    assert cli.main([*command, '-o', str(out)]) == 0
    text = capsys.readouterr().out
    assert f'Measured in {tmp_path / "pull.csv"}: displacement of x [mm], y [mm], ' in text
    assert ' % smaller than the one before' in text
    assert 'far from usual' not in text
    facts = info(out, capsys)
    assert facts['frequencies'][0] == pytest.approx(float(sim.frequencies()[0]), rel=5e-3)
    assert facts['modes'][0]['damping_ratio'] == pytest.approx(0.06, rel=0.05)
    assert facts['modulus'] == pytest.approx(7e9, rel=0.01)


def test_the_wood_of_the_tree_is_kept_but_for_what_was_measured(
    tree: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / 'fitted.yaml'
    assert (
        cli.main(['calibrate', str(tree), '--density', '777', '--frequency', '1', '-o', str(out)])
        == 0
    )
    text = capsys.readouterr().out
    assert 'damping    stays 0.06 bare, as it was not measured: --damping' in text
    before, after = open_tree(tree), open_tree(out)
    assert after.species.density == 777.0
    assert (after.species.damping_bare, after.species.damping_in_leaf) == (0.06, 0.06)
    assert np.array_equal(before.tree.end, after.tree.end)


def test_roots_that_change_with_the_modulus_are_said(
    tree: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    rooted = tree.with_name('rooted.yaml')
    rooted.write_text(TREE.replace('modulus: 7.0e+9', 'modulus: 7.0e+9, root_stiffness: 4000.0'))
    frequency = info(rooted, capsys)['frequencies'][0]
    fitted = tree.with_name('fitted.yaml')
    words = ['calibrate', str(rooted), '--frequency', f'{1.05 * frequency}', '-o', str(fitted)]
    assert cli.main(words) == 0
    after = open_tree(str(fitted)).species.root_stiffness
    assert f'roots      4e+03 -> {after:.3g} N m/rad' in capsys.readouterr().out
    assert after > 4000.0


def test_a_modulus_that_no_wood_has_is_said(
    tree: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert (
        cli.main(['calibrate', str(tree), '--frequency', '9', '-o', str(tmp_path / 'x.yaml')]) == 0
    )
    out, err = capsys.readouterr()
    assert '7.03 times the usual one of ash' in out
    assert 'that is far from usual: first check the diameters' in out
    assert 'warning: a modulus of 66.8 GPa' in err


def test_a_sway_that_no_wood_gives_is_refused(
    tree: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    output = tmp_path / 'x.yaml'
    assert cli.main(['calibrate', str(tree), '--frequency', '90', '-o', str(output)]) == 2
    assert 'GPa, where green wood has 3 to 20; check the frequency' in capsys.readouterr().err
    assert not output.exists()


def sample(path: Path, motion: str) -> str:
    """Write a file of one column, written as Python."""
    rng = np.random.default_rng(0)
    t = np.arange(0.0, 60.0, 0.05)
    values = eval(motion, {'t': t, 'rng': rng, 'np': np})
    path.write_text(
        '\n'.join(['time,x', *(f'{a:.3f},{b:.6g}' for a, b in zip(t, values, strict=False))])
    )
    return str(path)


@pytest.mark.parametrize(
    ('motion', 'more', 'expected'),
    [
        (None, [], 'neither of --frequency and --record; give one of the two'),
        ('np.sin(t)', ['--frequency', '1'], 'both of --frequency and --record'),
        (None, ['--frequency', '-1'], '--frequency: -1.0 is out of range'),
        (None, ['--frequency', 'nan'], '--frequency: nan is out of range'),
        (None, ['--frequency', '1', '--damping', '2'], '--damping: 2.0 is out of range'),
        (None, ['--frequency', '1', '--band', '1', '2'], '--band: no record; give --record too'),
        (None, ['--frequency', '1e-6'], 'out of reach: the tree sways at'),
        ('rng.normal(size=1200)', [], 'rec.csv: '),
        (
            'np.exp(-.1*t)*np.sin(3*t)*(t<9)+np.where(t==3, np.nan, 0)',
            [],
            "rec.csv:62: x is 'nan'",
        ),
        ('np.sin(t[:100])*np.exp(-.1*t[:100])', [], 'rec.csv: '),
        ('np.sin(t)', ['--band', '3', '2'], 'band 3 to 2 Hz; give two rising'),
        ('0*t', [], 'rec.csv: nothing moves'),
    ],
)
def test_what_the_user_can_mend_is_one_line_and_exit_code_2(
    tree: Path,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    motion: str | None,
    more: list[str],
    expected: str,
) -> None:
    given = ['--record', sample(tmp_path / 'rec.csv', motion)] if motion else []
    out = tmp_path / 'fitted.yaml'
    assert cli.main(['calibrate', str(tree), *given, *more, '-o', str(out)]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith('tree-sway calibrate: ')
    assert expected in line
    assert not out.exists()


def test_only_yaml_can_carry_wood(tree: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(['calibrate', str(tree), '--frequency', '1', '-o', 'x.glb']) == 2
    assert "'x.glb' cannot store wood; write a .yaml file" in capsys.readouterr().err
