# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``tree-sway simulate --motion``: the motion follows a recording of a sensor on the tree."""

from __future__ import annotations

import csv
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from tree_sway_lab.twin.simulated_sensor import SimulatedSensor

from tree_sway.commands.cli import main
from tree_sway.core.arrays import Floats
from tree_sway.core.scene.make import make_simulator
from tree_sway.core.species.species import species_named
from tree_sway.core.wind.turbulence import simulate_turbulence
from tree_sway.files.trees.source import open_scene, open_tree
from tree_sway.growth.builtin import builtin_tree
from tree_sway.simulation.commands.exposure import touched_species
from tree_sway.simulation.exposure import CONTACT, exposure_of
from tree_sway.twin.sensor_place import place_on

DT = 1.0 / 60.0


@cache
def swayed(seconds: float) -> tuple[Floats, dict[str, str]]:
    """Return the displacements of a softer tree, (n, 3), and tables of its wind and its motion."""
    tree, species = builtin_tree('goldcrest'), species_named('goldcrest')
    softer = replace(species, modulus=0.8 * species.modulus)
    sim = make_simulator(tree, softer, model=40, crown_coherence=0.3)
    rng = np.random.default_rng(3)
    wind = simulate_turbulence(4.0, rate=60.0, duration=seconds, rng=rng)
    segment = place_on(tree, f'{tree.branch_names[0]}:0.6').segment
    tips, poses = np.empty((len(wind), 3)), np.empty((len(wind), 7))
    for k, each in enumerate(wind):
        sim.step(each, DT)
        tips[k] = sim.tip_displacement
        poses[k] = sim.place()[segment]
    sensor = SimulatedSensor(Rotation.from_euler('xyz', [1.0, 2.0, 3.0]), rate=100.0)
    motion = sensor.measured(poses, DT, rng)
    sensed = [motion.time, *motion.acceleration.T, *motion.rate.T]
    tables = {}
    for name, head, columns in (
        ('wind', 'time,u,v,w', [DT * np.arange(len(wind)), *wind.T]),
        ('motion', 'time,ax,ay,az,gx,gy,gz', sensed),
    ):
        rows = '\n'.join(','.join(f'{x:.9g}' for x in row) for row in zip(*columns, strict=True))
        tables[f'{name}.csv'] = f'{head}\n{rows}\n'
    return tips, tables


def recorded(folder: Path, seconds: float = 45.0) -> Floats:
    """Write a wind and the motion of a softer tree in it; return its displacements, (n, 3)."""
    tips, tables = swayed(seconds)
    for name, text in tables.items():
        (folder / name).write_text(text, encoding='utf-8')
    return tips


def tips_of(path: Path) -> Floats:
    with path.open(encoding='utf-8') as file:
        rows = list(csv.reader(file))
    columns = [i for i, name in enumerate(rows[0]) if 'tip' in name]
    return np.array([[float(row[i]) for i in columns] for row in rows[1:]])


def test_the_motion_follows_the_recording(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    true = recorded(tmp_path)
    at = f'{builtin_tree("goldcrest").branch_names[0]}:0.6'
    common = ['simulate', 'goldcrest', '--wind', 'wind.csv']
    assert main([*common, '-o', 'alone.csv']) == 0
    assert main([*common, '--motion', 'motion.csv', '--at', at, '-o', 'twin.csv']) == 0
    notes = capsys.readouterr().err
    assert 'motion.csv: read ax, ay, az, gx, gy, gz' in notes
    assert 'as it and the wind have no dates, it is taken to begin with the wind' in notes
    assert 'samples followed, 0 refused' in notes
    assert 'synchronise those of wind and motion' in notes
    after = slice(30 * 60, 44 * 60)
    errors = []
    for name in ('alone', 'twin'):
        wrong = tips_of(tmp_path / f'{name}.csv')[after] - true[after]
        errors.append(float(np.std(wrong, axis=0).max()))
    assert errors[1] < 0.5 * errors[0]


def test_a_clock_that_is_late_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    recorded(tmp_path)
    at = f'{builtin_tree("goldcrest").branch_names[0]}:0.6'
    line = ['simulate', 'goldcrest', '--wind', 'wind.csv', '--motion', 'motion.csv', '--at', at]
    assert main([*line, '--motion-starts', '3', '-o', 'twin.csv']) == 0
    assert 'the tree moves 3.0 s after the wind: ' in capsys.readouterr().err


def test_a_tree_with_what_was_learned_opens_like_any_tree(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    recorded(tmp_path, 75.0)
    at = f'{builtin_tree("goldcrest").branch_names[0]}:0.6'
    command = ['simulate', 'goldcrest', '--wind', 'wind.csv', '--motion', 'motion.csv']
    assert main([*command, '--at', at, '--learn', 'own.twin.yaml', '-o', 'twin.csv']) == 0
    assert 'own.twin.yaml: goldcrest' in capsys.readouterr().out
    softer = open_tree('own.twin.yaml').species.modulus / species_named('goldcrest').modulus
    assert softer == pytest.approx(0.8, abs=0.08)
    assert main(['info', 'own.twin.yaml']) == 0
    assert f'stiffness {softer:.3g} times' in capsys.readouterr().out


def test_what_is_learned_in_a_stand_is_the_damping_without_neighbours(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    recorded(tmp_path, 75.0)
    at = f'{builtin_tree("goldcrest").branch_names[0]}:0.6'
    command = ['simulate', 'goldcrest', '--wind', 'wind.csv', '--motion', 'motion.csv', '--at', at]
    stand = ['--exposure', 'stand', '--leaves', 'on']
    assert main([*command, *stand, '--learn', 'own.yaml', '-o', 'twin.csv']) == 0
    found = open_tree('own.yaml')
    assert found.learned is not None
    own = found.species.damping_in_leaf
    expected = species_named('goldcrest').damping_in_leaf
    assert own == pytest.approx(found.learned.damping * expected)
    (placed,) = open_scene('own.yaml').trees
    exposure = exposure_of(placed.tree, placed.species, 'stand')
    among = touched_species(exposure, placed.species, placed.learned)
    assert among.damping_in_leaf == pytest.approx(CONTACT['stand'] * own)


def test_without_enough_sway_no_tree_is_written(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    recorded(tmp_path, 10.0)
    command = ['simulate', 'goldcrest', '--wind', 'wind.csv', '--motion', 'motion.csv']
    assert main([*command, '--at', '1.0', '--learn', 'own.yaml', '-o', 'twin.csv']) == 0
    assert 'own.yaml is not written' in capsys.readouterr().err
    assert not Path('own.yaml').exists()


@pytest.mark.parametrize(
    ('extra', 'what'),
    [
        (['--learn', 'own.yaml'], 'no motion sensor to learn from'),
        (['--motion', 'motion.csv', '--at', '1.0', '--learn', 'own.glb'], 'cannot store'),
        (['--motion', 'motion.csv'], '1 --motion and 0 --at'),
        (['--motion', 'motion.csv', '--at', '99'], ': --at: the stem has no height'),
        (['--motion', 'missing.csv', '--at', '0.3'], 'missing.csv'),
        (['--motion', 'motion.csv', '--at', '0.3', '--motion-starts', 'nan'], '--motion-starts'),
    ],
)
def test_mistakes_are_told_with_the_cure(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch,
    extra: list[str], what: str,
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    (tmp_path / 'motion.csv').write_text('time,ax,ay,az\n0,0,0,9.8\n', encoding='utf-8')
    assert main(['simulate', 'goldcrest', *extra, '-o', 'x.csv']) == 2
    assert what in capsys.readouterr().err


def test_motion_of_another_time_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    rows = [f'{0.02 * k:.2f},0,0,9.8' for k in range(50)]
    (tmp_path / 'motion.csv').write_text('\n'.join(['time,ax,ay,az', *rows]), encoding='utf-8')
    words = ['simulate', 'goldcrest', '--seconds', '1', '--motion', 'motion.csv', '--at', '0.3']
    assert main([*words, '--motion-starts', '5000', '-o', 'x.csv']) == 0
    assert 'samples are of 5000 to 5000.98 s, and the wind of 0 to 1 s' in capsys.readouterr().err
