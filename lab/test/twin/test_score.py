# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``tree-sway lab score``: known differences in closed form, and a record from its files."""

from __future__ import annotations

import csv
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from tree_sway_lab.twin.simulated_sensor import SimulatedSensor
from tree_sway_lab.twin.sway_comparison import compare_sway

from tree_sway.commands.cli import main
from tree_sway.core.scene.make import make_simulator
from tree_sway.core.species.species import species_named
from tree_sway.core.wind.turbulence import simulate_turbulence
from tree_sway.files.export.tree_export import write_tree
from tree_sway.growth.builtin import builtin_tree
from tree_sway.growth.growing import grow
from tree_sway.twin.sensor_place import bend_at, place_on, strain_of

RATE, FREQUENCY = 20.0, 0.5
DT = 1.0 / 60.0


def test_a_lag_and_an_amplitude_are_found() -> None:
    rng = np.random.default_rng(2)
    measured = np.cumsum(rng.normal(size=(4000, 2)), axis=0)
    measured -= np.linspace(0.0, 1.0, 4000)[:, None] * measured[-1]
    found = compare_sway(0.9 * np.roll(measured, 8, axis=0), measured, RATE, FREQUENCY)
    assert found.lag == pytest.approx(8 / RATE)
    assert found.r == pytest.approx(1.0, abs=1e-3)
    assert found.rms == pytest.approx(0.9, rel=1e-6)
    assert found.bands == pytest.approx([0.81] * 4, rel=0.02)


def test_bands_beyond_what_was_sampled_are_unknown() -> None:
    motion = np.random.default_rng(3).normal(size=(500, 2))
    found = compare_sway(motion, motion, 6.0, FREQUENCY)
    assert np.isfinite(found.bands).tolist() == [True, True, True, False]


def test_a_motion_of_noise_is_not_correlated() -> None:
    first, second = np.random.default_rng(4).normal(size=(2, 4000, 2))
    found = compare_sway(first, second, RATE, FREQUENCY)
    assert abs(found.r) < 0.1
    assert found.error == pytest.approx(np.sqrt(2.0), rel=0.05)


def write(path: Path, head: str, *columns: np.ndarray) -> None:
    rows = '\n'.join(','.join(f'{x:.9g}' for x in row) for row in zip(*columns, strict=True))
    path.write_text(f'{head}\n{rows}\n', encoding='utf-8')


def make_record(folder: Path) -> str:
    """Write wind, sway and motion of a softer tree; return the place of the sensor."""
    tree, species = builtin_tree('goldcrest'), species_named('goldcrest')
    softer = replace(species, modulus=0.8 * species.modulus)
    sim = make_simulator(tree, softer, model=40, crown_coherence=0.3)
    rng = np.random.default_rng(3)
    wind = simulate_turbulence(4.0, rate=60.0, duration=80.0, rng=rng)
    at = f'{tree.branch_names[0]}:0.6'
    segment = place_on(tree, at).segment
    tips, poses = np.empty((len(wind), 3)), np.empty((len(wind), 7))
    for k, each in enumerate(wind):
        sim.step(each, DT)
        tips[k], poses[k] = sim.tip_displacement, sim.place()[segment]
    motion = SimulatedSensor(rate=100.0).measured(poses, DT, rng)
    time = DT * np.arange(len(wind))
    write(folder / 'wind.csv', 'time,u,v,w', time, *wind.T)
    write(folder / 'sway.csv', 'time,x [m],y [m]', time[::3], *tips[::3, :2].T)
    sensed = [*motion.acceleration.T, *motion.rate.T]
    write(folder / 'motion.csv', 'time,ax,ay,az,gx,gy,gz', motion.time, *sensed)
    return at


def test_a_record_is_scored_with_and_without_its_sensor(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    at = make_record(tmp_path)
    words = 'lab score goldcrest --wind wind.csv --sway sway.csv --motion motion.csv'.split()
    assert main([*words, '--at', at]) == 0
    lines = capsys.readouterr().out.splitlines()
    rows = {each['motion']: each for each in csv.DictReader(lines)}
    errors = {name: float(row['error']) for name, row in rows.items()}
    assert list(errors) == ['U^2', 'model', 'sensors']
    assert errors['sensors'] < 0.5 * min(errors['model'], errors['U^2'])
    assert float(rows['sensors']['r']) > 0.95
    assert abs(float(rows['sensors']['lag'])) <= 0.05


@pytest.mark.parametrize(
    ('head', 'seconds', 'what'),
    [
        ('time,ax,ay', 80.0, 'columns of acceleration'),
        ('time,x,y', 50.0, 'less than 30 s of sway'),
    ],
)
def test_another_record_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch,
    head: str, seconds: float, what: str,
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    time = np.arange(0.0, seconds, 0.1)
    write(tmp_path / 'sway.csv', head, time, np.sin(time), np.cos(time))
    write(tmp_path / 'wind.csv', 'time,u,v,w', time, *np.ones((3, len(time))))
    assert main('lab score goldcrest --wind wind.csv --sway sway.csv'.split()) == 2
    assert what in capsys.readouterr().err


def make_strains(folder: Path) -> None:
    """Write wind, and strain at three heights of a softer tree, beside a pair of another tree."""
    species = species_named('spruce')
    tree = grow('spruce', 16.0, rng=np.random.default_rng(3))
    write_tree(folder / 'tree.yaml', tree, species)
    softer = replace(species, modulus=0.8 * species.modulus)
    sim = make_simulator(tree, softer, model=60, crown_coherence=0.3)
    rng = np.random.default_rng(8)
    wind = simulate_turbulence(7.0, rate=60.0, duration=90.0, rng=rng)
    places = [place_on(tree, f'{height} strain') for height in HEIGHTS]
    found = np.empty((len(wind), 2 * len(places) + 2))
    for k, each in enumerate(wind):
        sim.step(each, DT)
        poses = sim.place()
        found[k, 2:] = np.concatenate([strain_of(bend_at(tree, poses, at)) for at in places])
    found[:, :2] = found[::-1, :2] = 1e-5 * rng.normal(size=(len(wind), 2))
    drift = 1e-5 * np.arange(len(wind))[:, None] / len(wind)
    found += 2e-6 * rng.normal(size=found.shape) + drift
    ends = DT * np.arange(1, len(wind) + 1)
    rows = slice(None, None, 15)
    write(folder / 'strain.csv', 'time' + ',x' * found.shape[1], ends[rows], *found[rows].T)
    write(folder / 'wind.csv', 'time,u,v,w', ends - 0.5 * DT, *wind.T)


HEIGHTS = (1.3, 5.0, 9.0)


def test_the_lowest_gauge_corrects_and_the_highest_judges(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    make_strains(tmp_path)
    words = 'lab score tree.yaml --wind wind.csv --strain strain.csv --gauges'.split()
    assert main([*words, '- ' + ' '.join(map(str, HEIGHTS))]) == 0
    captured = capsys.readouterr()
    rows = {each['motion']: each for each in csv.DictReader(captured.out.splitlines())}
    print(captured.out, captured.err)
    errors = {name: float(row['error']) for name, row in rows.items()}
    assert list(errors) == ['U^2', 'model', 'sensors']
    assert errors['sensors'] < min(0.6 * errors['model'], 0.8 * errors['U^2'])
    assert float(rows['sensors']['r']) > 0.9
    assert main([*words, '1.3 5']) == 2
    assert '2 places for 4 pairs of columns' in capsys.readouterr().err
