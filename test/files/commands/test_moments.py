# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``tree-sway convert --at``: still scenes of a tree or a forest in wind."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tree_sway.commands import cli
from tree_sway.errors import ParameterError
from tree_sway.files.commands.moments import moments_of
from tree_sway.files.trees.source import open_tree

SEEDLING = str(Path(__file__).parents[2] / 'files' / 'data' / 'seedling.yaml')


def vertices(path: Path) -> np.ndarray:
    lines = path.read_text().splitlines()
    return np.array([line.split()[1:] for line in lines if line.startswith('v ')], dtype=float)


def test_moments_are_one_or_many() -> None:
    assert moments_of('5') == [5.0]
    assert moments_of('0:1:0.25') == [0.0, 0.25, 0.5, 0.75, 1.0]
    assert len(moments_of('0:10:0.1')) == 101
    assert moments_of('2:2.9:0.5') == [2.0, 2.5]
    for text in ('', 'now', '1:2', '2:1:0.1', '0:1:0', '0:1:-1', 'nan', '-1', '0:80000:0.1'):
        with pytest.raises(ParameterError, match='--at'):
            moments_of(text)


def test_a_tree_in_wind_is_a_file_per_moment(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    wind = tmp_path / 'wind.csv'
    rows = [f'{0.1 * k:.1f},12,0,0' for k in range(40)]
    wind.write_text('\n'.join(['time,u,v,w', *rows]) + '\n')
    pattern = str(tmp_path / 'scene_%02d.obj')
    given = ['convert', SEEDLING, '--leaves', 'on', '--wind', str(wind), '--at', '0:2:0.5']
    assert cli.main([*given, '-o', pattern]) == 0
    assert 'scene_00.obj to scene_04.obj, 5 moments' in capsys.readouterr().out
    paths = sorted(tmp_path.glob('*.obj'))
    assert len(paths) == 5
    places = [vertices(path) for path in paths]
    rest = tmp_path / 'rest.obj'
    assert cli.main(['convert', SEEDLING, '--leaves', 'on', '-o', str(rest)]) == 0
    np.testing.assert_allclose(places[0], vertices(rest), atol=1e-4)
    # Blown to the east from rest: the top moves, the root does not.
    moved = [each - places[0] for each in places]
    top = int(np.argmax(places[0][:, 2]))
    assert min(each[top, 0] for each in moved[1:]) > 1e-3
    low = places[0][:, 2] < 1e-3
    assert np.abs(moved[-1][low]).max() < 1e-3
    # A moment alone is that of many, to the digits of the file.
    numbered, alone = tmp_path / 'alone_%d.obj', tmp_path / 'alone_0.obj'
    capsys.readouterr()
    assert cli.main([*given[:-1], '1', '-o', str(numbered)]) == 0
    assert str(alone) in capsys.readouterr().out
    np.testing.assert_allclose(vertices(alone), places[2], atol=2e-3)
    text = paths[2].read_text()
    assert text.startswith('# seedling at 1.0000 s; metres, x east, y north, z up\n')
    assert 'usemtl wood' in text
    assert 'usemtl leaves' in text


def test_a_mesh_reader_finds_the_volume_of_the_wood(tmp_path: Path) -> None:
    trimesh = pytest.importorskip('trimesh', reason='needs trimesh')
    path = tmp_path / 'tree.obj'
    assert cli.main(['convert', 'goldcrest', '--leaves', 'off', '-o', str(path)]) == 0
    mesh = trimesh.load(path, force='mesh')
    # A cone of six sides has 0.827 of the volume of a round one.
    assert mesh.volume == pytest.approx(0.827 * open_tree('goldcrest').tree.volume.sum(), rel=0.02)


@pytest.mark.parametrize(
    ('arguments', 'message'),
    [
        (['--at', '0:1:0.5', '-o', 'one.obj'], '3 moments in one file; name files with a number'),
        (['--at', '1', '-o', 'one.glb'], "--at: 'one.glb' is of no moment; write .obj"),
        (['--at', '1:2', '-o', 'one.obj'], "--at: '1:2' names no moments"),
        (['-o', 'one.stl'], '.obj'),
    ],
)
def test_what_is_no_moment(
    arguments: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main(['convert', SEEDLING, *arguments]) == 2
    assert message in capsys.readouterr().err


def test_a_file_that_is_there_stays(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    there = tmp_path / 's_1.obj'
    there.write_text('mine')
    given = ['convert', SEEDLING, '--at', '0:0.2:0.1', '-o', str(tmp_path / 's_%d.obj')]
    assert cli.main(given) == 2
    assert "s_1.obj' exists" in capsys.readouterr().err
    assert there.read_text() == 'mine'
    assert not (tmp_path / 's_0.obj').exists()
    assert cli.main([*given, '--force']) == 0
    assert there.read_text().startswith('# seedling at 0.1')
