# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What `tree-sway info` says, against what is known of the tree."""

from __future__ import annotations

import contextlib
import io
import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tree_sway_lab.bench.bench_tree import bench_tree

from tree_sway.commands import cli
from tree_sway.core.scene.placed_tree import PlacedTree
from tree_sway.core.settings import Settings
from tree_sway.core.tree.building import tree_from_segments
from tree_sway.errors import ParameterError
from tree_sway.files.export.tree_export import write_tree
from tree_sway.growth.growing import grow

MODULUS, DENSITY = 8e9, 900.0


def facts(capsys: pytest.CaptureFixture[str], *arguments: str) -> dict[str, Any]:
    """Return what the command says of a tree, for programs."""
    assert cli.main(['info', *arguments, '--json']) == 0
    found = json.loads(capsys.readouterr().out)
    assert isinstance(found, dict)
    return found


@pytest.fixture(scope='module')
def goldcrest() -> dict[str, Any]:
    """Return what is said of it as it is."""
    with contextlib.redirect_stdout(io.StringIO()) as printed:
        assert cli.main(['info', 'goldcrest', '--json']) == 0
    found = json.loads(printed.getvalue())
    assert isinstance(found, dict)
    return found


def write_pole(path: Path, length: float, diameter: float, n: int = 20) -> str:
    """Write a clamped uniform rod, leaning a little to the east."""
    along = np.array([0.2, 0.0, 1.0]) / np.hypot(0.2, 1.0)
    nodes = np.outer(np.linspace(0.0, length, n + 1), along)
    write_tree(path, tree_from_segments(nodes[:-1], nodes[1:], np.full(n, diameter)))
    return str(path)


def test_a_clamped_rod_has_the_frequency_of_the_books(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Uniform cantilever: w = 3.516 sqrt(EI / rho A L^4) (Blevins 1979, table 8-1)."""
    length, diameter = 3.0, 0.05
    path = write_pole(tmp_path / 'pole.yaml', length, diameter)
    wood = ['--modulus', str(MODULUS), '--density', str(DENSITY), '--gravity', 'off']
    found = facts(capsys, path, *wood, '--count', '2')
    radius_of_gyration = diameter / 4.0
    wave = np.sqrt(MODULUS / DENSITY) * radius_of_gyration / length**2
    assert found['frequencies'] == pytest.approx([3.516 * wave / (2 * np.pi)] * 2, rel=0.01)
    assert found['mass'] == pytest.approx(DENSITY * np.pi / 4 * diameter**2 * length)
    assert found['breast_height_diameter'] == pytest.approx(diameter)


def test_its_own_weight_makes_a_tree_softer(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write_pole(tmp_path / 'pole.yaml', 8.0, 0.05)
    with_weight = facts(capsys, path, '--gravity', 'on')['frequencies'][0]
    without = facts(capsys, path, '--gravity', 'off')['frequencies'][0]
    assert with_weight < 0.99 * without


def test_a_tree_that_cannot_stand_has_its_size_reported(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write_pole(tmp_path / 'pole.yaml', 30.0, 0.02)
    found = facts(capsys, path)
    assert found['height'] == pytest.approx(30.0 / np.hypot(0.2, 1.0))
    assert 'buckles under its own weight' in found['warnings'][-1]
    assert found['mass'] == pytest.approx(DENSITY * np.pi / 4 * 0.02**2 * 30.0)
    assert found['frequencies'] == []


def write_scan(path: Path) -> str:
    """Write a pole of 20 m, 6 cm thick, as SimpleForest does: it cannot stand."""
    head = 'ID,parentID,startX,startY,startZ,endX,endY,endZ,radius,branchOrder,growthLength'
    rows = [f'{i},{i - 1},0,0,{2 * i},0,0,{2 * i + 2},0.03,0,{20 - 2 * i}' for i in range(10)]
    path.write_text('\n'.join([head, *rows]))
    return str(path)


def test_a_scan_that_cannot_stand_is_thickened_and_says_so(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write_scan(tmp_path / 'pole.csv')
    found = facts(capsys, path, '--leaves', 'on')
    assert found['gravity'] > 0.0
    assert found['frequencies'][0] > 0.01
    assert 'of 10 segments of 1 limb thickened' in found['warnings'][0]
    assert 'of wood added' in found['warnings'][0]
    as_it_is = facts(capsys, path, '--leaves', 'on', '--option', 'thicken=no')
    assert as_it_is['base_diameter'] == pytest.approx(0.06)
    assert as_it_is['frequencies'] == []


def test_every_command_says_that_a_scan_was_changed(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write_scan(tmp_path / 'pole.csv')
    assert cli.main(['simulate', path, '--seconds', '1', '-o', str(tmp_path / 'sway.csv')]) == 0
    warned = [line for line in capsys.readouterr().err.splitlines() if 'thickened' in line]
    assert len(warned) == 1
    assert warned[0].startswith('warning: changed, as bare it could carry')


def test_natural_modes_are_listed(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / 'bench.yaml'
    write_tree(path, bench_tree())
    found = facts(capsys, str(path), '--count', '6')
    assert (found['branches'], found['segments']) == (121, 726)
    assert len(found['frequencies']) == 6
    assert found['frequencies'] == sorted(found['frequencies'])
    for mode in found['modes']:
        assert mode['damping_ratio'] == pytest.approx(0.04)


def write_whips(path: Path, n: int, diameter: float) -> str:
    """Write three rods of 1.5 m, in pieces, on a post of 1 m."""
    post = np.linspace([0.0, 0.0, 0.0], [0.0, 0.0, 1.0], 5)
    start, end, thickness, branch = [post[:-1]], [post[1:]], [np.full(4, 0.05)], [np.zeros(4, int)]
    for k, angle in enumerate(np.deg2rad([0.0, 120.0, 240.0])):
        tip = [1.5 * np.cos(angle), 1.5 * np.sin(angle), 1.3]
        nodes = np.linspace([0.0, 0.0, 1.0], tip, n + 1)
        start.append(nodes[:-1])
        end.append(nodes[1:])
        thickness.append(np.full(n, diameter))
        branch.append(np.full(n, k + 1))
    start, end, thickness, branch = map(np.concatenate, (start, end, thickness, branch))
    write_tree(path, tree_from_segments(start, end, thickness, branch=branch))
    return str(path)


def test_a_limp_tree_that_its_table_moves_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    wood = ['--modulus', str(MODULUS), '--density', str(DENSITY)]
    for n, diameter, is_told in ((1, 0.004, True), (2, 0.003, False), (1, 0.02, False)):
        path = write_whips(tmp_path / 'whips.yaml', n, diameter)
        warnings = facts(capsys, path, *wood)['warnings']
        assert any('no inertia to solve with' in each for each in warnings) == is_told


def test_leaves_weigh_and_slow(
    capsys: pytest.CaptureFixture[str], goldcrest: dict[str, Any]
) -> None:
    bare = facts(capsys, 'goldcrest', '--count', '1', '--leaves', 'off')
    leafy = goldcrest
    assert leafy['mass'] > bare['mass']
    assert leafy['frequencies'][0] < bare['frequencies'][0]
    assert leafy['modes'][0]['damping_ratio'] > bare['modes'][0]['damping_ratio']


def test_the_text_says_the_same(
    capsys: pytest.CaptureFixture[str], goldcrest: dict[str, Any]
) -> None:
    found = goldcrest
    assert cli.main(['info', 'goldcrest']) == 0
    text = capsys.readouterr().out
    assert f'{found["branches"]} branches, {found["segments"]} segments' in text
    assert f'{found["frequencies"][0]:.3f}' in text
    assert 'an estimate' in text


@pytest.mark.parametrize(
    ('option', 'cure'),
    [
        (('--modulus', '9.4'), 'give 1e+07 to 5e+11 Pa'),
        (('--density', '0.95'), 'give 40 to 10000 kg/m^3'),
    ],
)
def test_wood_in_another_unit_is_refused(
    capsys: pytest.CaptureFixture[str], option: tuple[str, str], cure: str
) -> None:
    assert cli.main(['info', 'goldcrest', *option]) == 2
    assert cure in capsys.readouterr().err


@pytest.mark.parametrize('branches', ['', 'a whole tree'])
def test_a_species_of_a_file_has_the_wood_of_the_file(
    branches: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A rod of 20 GPa sways faster than one of the table's 9.4 GPa by the root of their ratio."""
    pole = write_pole(tmp_path / 'pole.yaml', 3.0, 0.05)
    file = tmp_path / 'oak_stiff.yaml'
    kept: list[str] = []
    if branches:
        write_pole(file, 1.0, 0.02)
        rows = file.read_text('utf-8').splitlines()
        kept = [each for each in rows if not each.startswith(('species', 'wood'))]
    file.write_text('\n'.join(['species: oak', 'wood: {modulus: 20.0e9}', *kept]), 'utf-8')
    of_table = facts(capsys, pole, '--species', 'oak', '--gravity', 'off')
    of_file = facts(capsys, pole, '--species', str(file), '--gravity', 'off')
    assert of_file['modulus'] == 20.0e9
    ratio = of_file['frequencies'][0] / of_table['frequencies'][0]
    assert ratio == pytest.approx((20.0 / 9.4) ** 0.5, rel=1e-6)
    forest = tmp_path / 'forest.yaml'
    forest.write_text(f'trees: [{{name: a, tree: {pole}}}, {{name: b, tree: {pole}, x: 3}}]\n')
    assert cli.main(['info', str(forest), '--species', str(file)]) == 0
    of_forest = capsys.readouterr().out
    heavy = facts(capsys, pole, '--species', str(file))
    assert of_forest.count(f'{heavy["frequencies"][0]:.3f} Hz') == 2


def test_a_name_longer_than_a_line_is_cut_for_people_alone(tmp_path, capsys):
    name = 'a' * 200
    file = tmp_path / 'pole.yaml'
    write_pole(file, 3.0, 0.05)
    rows = [row for row in file.read_text('utf-8').splitlines() if not row.startswith('name:')]
    file.write_text('\n'.join([f'name: {name}', *rows]), 'utf-8')
    assert facts(capsys, str(file))['name'] == name
    assert cli.main(['info', str(file)]) == 0
    assert max(len(line) for line in capsys.readouterr().out.splitlines()) < 160


@pytest.mark.parametrize(
    ('text', 'expected'),
    [
        (None, 'no such file'),
        ('species: [oak]\n', 'species.yaml:1: species is a list'),
        ('species: okk\n', "species.yaml:1: unknown species 'okk'; did you mean 'oak'?"),
        ('name: oak\n', 'no species and no wood'),
        ('species: oak\nwood: {modulus: hard}\n', "species.yaml:2: wood.modulus is 'hard'"),
    ],
)
def test_a_species_of_a_file_that_cannot_be_read_is_named(
    text: str | None, expected: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / 'species.yaml'
    if text is not None:
        file.write_text(text, encoding='utf-8')
    assert cli.main(['info', 'goldcrest', '--species', str(file)]) == 2
    assert expected in capsys.readouterr().err


def test_what_is_odd_is_reported(
    capsys: pytest.CaptureFixture[str], goldcrest: dict[str, Any]
) -> None:
    assert goldcrest['warnings'] == []
    odd = facts(capsys, 'goldcrest', '--modulus', '1e11')['warnings']
    assert [each.split(',')[0] for each in odd] == ['a modulus of 100 GPa']


@pytest.mark.usefixtures('short_storms')
@pytest.mark.parametrize(('exposure', 'said'), [('open', 'outside'), ('stand', 'within')])
def test_the_published_moment_of_a_spruce_is_within_the_band_or_said_to_be_outside(
    exposure: str, said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """20 m and 25 cm: 112 d^2 h U^2 (Hale et al. 2012) is of trees that shelter each other."""
    tree = grow('spruce', 20.0, 0.25, rng=np.random.default_rng(0))
    path = tmp_path / 'spruce.yaml'
    write_tree(path, tree)
    words = ('--species', 'spruce', '--speed', '10', '--exposure', exposure, '--count', '1')
    found = facts(capsys, str(path), *words)
    # The wind in the open is measured at 10 m, that on a stand at its top.
    at_top = 10.0 if exposure == 'stand' else 10.0 * math.log(20.0 / 0.03) / math.log(10.0 / 0.03)
    published = 111.7 * 0.25**2 * 20.0 * at_top**2
    assert found['published_moment'] == pytest.approx(published, rel=0.01)
    (note,) = (each for each in found['notes'] if 'published' in each)
    assert f'{said} that band' in note


def test_a_tree_in_leaf_of_a_stand_is_damped_by_crowns_that_touch(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / 'birch.yaml'
    write_tree(path, grow('birch', 8.0, rng=np.random.default_rng(0)))
    damping = []

    def rig(tree: PlacedTree, settings: Settings) -> None:
        damping.append(tree.species.damping_in_leaf)
        raise ParameterError('far enough')

    monkeypatch.setattr('tree_sway.simulation.commands.strength.Rig', rig)
    for exposure in ('open', 'stand'):
        words = ['--speed', '10', '--exposure', exposure, '--count', '1']
        assert cli.main(['info', str(path), *words]) == 2
    assert damping[1] == pytest.approx(1.5 * damping[0])


def test_it_names_places_of_motion_sensors(capsys: pytest.CaptureFixture[str]) -> None:
    notes = ' '.join(facts(capsys, 'goldcrest', '--sensors', '2')['notes'])
    assert 'motion sensors tell most' in notes
    assert notes.count('% left') == 2


@pytest.mark.parametrize(('diameter', 'where', 'is_asked'), [
    (0.05, 'open', True), (0.05, 'stand', False), (0.07, 'street', False),
])  # fmt: skip
def test_a_slender_tree_of_the_open_is_asked_whether_it_stood_in_a_stand(
    diameter: float,
    where: str,
    is_asked: bool,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    path = write_pole(tmp_path / 'pole.yaml', 6.0, diameter)
    cli.main(['info', path, '--speed', '3', '--exposure', where])
    said = capsys.readouterr()
    assert ('did it stand in one? With --exposure stand' in said.err) == is_asked
    assert 'roots      do not turn' in said.out


def test_a_tree_below_the_top_of_its_stand_is_sheltered_by_it(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write_pole(tmp_path / 'pole.yaml', 6.0, 0.07)
    stand = ['--speed', '5', '--exposure', 'stand']
    own, low, high = (
        facts(capsys, path, *stand, *height)['strength']['base_moment']
        for height in (
            [],
            ['--stand-height', f'{6.0 / np.hypot(0.2, 1.0)}'],
            ['--stand-height', '12'],
        )
    )
    assert low == pytest.approx(own)
    assert high < 0.5 * own
    assert cli.main(['info', path, '--speed', '5', '--stand-height', '12']) == 2
    assert '--stand-height: trees in the open' in capsys.readouterr().err
