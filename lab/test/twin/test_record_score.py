# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``tree-sway lab twin RECORD``: sensors held out of a made-up record, and mistakes."""

from __future__ import annotations

import csv
from dataclasses import replace
import io
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from tree_sway_lab.twin.read_record import is_tree_record, read_tree_record
from tree_sway_lab.twin.simulated_sensor import SimulatedSensor

from tree_sway.commands.cli import main
from tree_sway.core.arrays import Floats
from tree_sway.core.scene.make import make_simulator
from tree_sway.core.species.species import species_named
from tree_sway.core.wind.turbulence import simulate_turbulence
from tree_sway.files.export.tree_export import write_tree
from tree_sway.files.motion.tree_record import RecordedSensor, TreeRecord, write_tree_record
from tree_sway.growth.builtin import builtin_tree
from tree_sway.twin.sensor_place import place_on

DT, SECONDS, EPOCH = 1.0 / 60.0, 90, 1_790_000_000.0


def write(path: Path, head: str, time: Floats, *columns: Floats) -> None:
    rows = zip(EPOCH + time, *columns, strict=True)
    lines = '\n'.join(','.join(f'{x:.16g}' for x in row) for row in rows)
    path.write_text(f'{head}\n{lines}\n', encoding='utf-8')


def make_record(folder: Path, missed: float = 0.7) -> None:
    """Record a softer tree with two sensors, in a wind of which the anemometer misses a part."""
    tree, species = builtin_tree('goldcrest'), species_named('goldcrest')
    softer = replace(species, modulus=0.8 * species.modulus)
    sim = make_simulator(tree, softer)
    rng = np.random.default_rng(5)
    wind, other = (
        simulate_turbulence(4.0, rate=60.0, duration=SECONDS, rng=rng) for _ in range(2)
    )
    stem = tree.branch_names[0]
    places = [f'{stem}:0.5', f'{stem}:0.8']
    segments = [place_on(tree, at).segment for at in places]
    poses = np.empty((2, len(wind), 7))
    for k, each in enumerate(wind + missed * (other - other.mean(axis=0))):
        sim.step(each, DT)
        poses[:, k] = sim.place()[segments]
    folder.mkdir()
    write_tree(folder / 'tree.yaml', tree, species)
    write(folder / 'wind.csv', 'time,u,v,w', DT * np.arange(len(wind)), *wind.T)
    for number, path in enumerate(poses, 1):
        mount = Rotation.random(rng=rng)
        motion = SimulatedSensor(mount, rate=100.0).measured(path, DT, rng)
        write(
            folder / f'motion_{number}.csv', 'time,ax,ay,az,gx,gy,gz',
            motion.time, *motion.acceleration.T, *motion.rate.T,
        )  # fmt: skip
    sensors = [RecordedSensor(f'motion_{n}.csv', at) for n, at in enumerate(places, 1)]
    write_tree_record(TreeRecord(folder, 'tree.yaml', 'wind.csv', sensors))


def test_a_sensor_that_is_held_out_follows_from_the_other(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / 'oak'
    make_record(folder)
    assert main(['lab', 'twin', str(folder)]) == 0
    told = capsys.readouterr().out
    print(told)
    rows = list(csv.DictReader(io.StringIO(told)))
    assert [row['motion'] for row in rows] == ['U^2', 'model', 'sensors'] * 2
    assert {row['quantity'] for row in rows} == {'rate'}
    for first in (0, 3):
        squared, alone, followed = rows[first : first + 3]
        assert float(followed['r']) > 0.9
        assert float(followed['error']) < 0.6 * float(alone['error'])
        assert float(alone['r']) > float(squared['r'])


def test_a_sheet_is_read_as_it_was_written(tmp_path: Path) -> None:
    record = TreeRecord(
        tmp_path, 'tree.yaml', 'wind.csv', (RecordedSensor('m.csv', '3.2', 'phyphox'),), 'off',
        'tempest', 'sway.csv', 'b12', 'after rain',
    )  # fmt: skip
    write_tree_record(record)
    assert is_tree_record(tmp_path)
    assert read_tree_record(tmp_path) == record
    assert read_tree_record(tmp_path / 'record.yaml') == record


@pytest.mark.parametrize(
    ('text', 'words'),
    [
        ('', 'empty'),
        ('tree: a.yaml', 'wind'),
        ('{tree: a.yaml, wind: {file: ../secret.csv}}', 'is no name of a file'),
        ('{tree: a.yaml, wind: {file: w.csv}, motion: [{file: m.csv}]}', 'at'),
        ('{tree: a.yaml, wind: {file: w.csv}, leaves: maybe}', 'leaves'),
        ('{tree: a.yaml, wind: {file: w.csv}}', 'a.yaml'),
    ],
)
def test_mistakes_in_a_sheet_are_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], text: str, words: str
) -> None:
    (tmp_path / 'record.yaml').write_text(text)
    assert main(['lab', 'twin', str(tmp_path)]) == 2
    assert words in capsys.readouterr().err
