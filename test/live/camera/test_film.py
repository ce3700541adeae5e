# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Films in files, live cameras, and what is said of those that cannot be opened."""

from __future__ import annotations

from pathlib import Path
import time
from typing import Any

import numpy as np
import pytest

from test.kit.filmed_pictures import clicks, picture, SIZE, spruce
from tree_sway.commands.cli import main
from tree_sway.core.scene import make_simulator
from tree_sway.core.tree import ends_of_poses
from tree_sway.errors import MissingDependencyError, ParameterError
from tree_sway.files.export import write_tree
from tree_sway.live import CameraView, Film, LiveFilm
from tree_sway.live.camera import camera_view

RATE, SECONDS = 30, 6


@pytest.fixture(scope='module')
def cv2() -> Any:
    return pytest.importorskip('cv2', reason='needs OpenCV: pip install .[camera]')


@pytest.fixture(scope='module')
def folder(tmp_path_factory: pytest.TempPathFactory, cv2: Any) -> Path:
    """Draw a film of a spruce of 3 m in gusts from the west, the tree and its clicks."""
    folder = tmp_path_factory.mktemp('film')
    tree = spruce()
    write_tree(folder / 'tree.yaml', tree)
    true = make_simulator(tree)
    path = str(folder / 'film.mp4')
    film = cv2.VideoWriter(path, cv2.VideoWriter_fourcc(*'mp4v'), RATE, SIZE)
    moved = []
    for k in range(RATE * SECONDS):
        if k:
            for _ in range(2):
                true.step([9.0 + 5.0 * np.sin(2.0 * k / RATE), 0.0, 0.0], 0.5 / RATE)
        poses = true.place()
        moved.append(ends_of_poses(poses, tree.length)[1][tree.branch_first[1] - 1])
        film.write(cv2.cvtColor(picture(cv2, tree, poses), cv2.COLOR_GRAY2BGR))
    film.release()
    np.save(folder / 'stem.npy', moved)
    (folder / 'clicks.txt').write_text(clicks(tree), encoding='utf-8')
    return folder


def test_simulate_follows_a_film_without_wind(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    check, sway = folder / 'check.png', folder / 'sway.csv'
    at = (folder / 'clicks.txt').read_text(encoding='utf-8') + f';check={check}'
    words = ['simulate', str(folder / 'tree.yaml'), '--leaves', 'off']
    words += ['--motion', f'camera:{folder / "film.mp4"}', '--at', at]
    assert main([*words, '--branch', 'stem', '-o', str(sway)]) == 0
    said = capsys.readouterr().err
    assert 'clicks miss by' in said
    assert 'points on the tree' in said
    assert check.stat().st_size > 1000
    table = np.genfromtxt(sway, delimiter=',', names=True)
    found = table['stem_tip_x_m'][1::2]
    true = np.load(folder / 'stem.npy')[1:, 0]
    true = (true - np.load(folder / 'stem.npy')[0, 0])[: len(found)]
    later = slice(RATE, None)
    wrong = found[: len(true)][later] - true[later]
    assert np.sqrt(np.square(wrong).mean() / np.square(true[later]).mean()) < 0.2


def test_a_live_source_is_followed_beside_and_ends(folder: Path, cv2: Any) -> None:
    film = Film(f'camera:{folder / "film.mp4"}')
    assert not film.is_live
    told: list[str] = []
    view = CameraView(spruce(), str(folder / 'clicks.txt'), told.append)
    live = LiveFilm(film, view, told.append)
    live.start()
    seen = []
    end = time.monotonic() + 20.0
    while len(seen) < 5 and time.monotonic() < end:
        seen += live.drain()
    live.stop()
    assert len(seen) >= 5
    assert abs(seen[0].time - time.monotonic()) < 30.0
    assert any('pictures come' in each for each in told)


def test_a_view_refuses_clicks_beside_the_tree_and_another_size(cv2: Any) -> None:
    tree = spruce()
    with pytest.raises(ParameterError, match='b999'):
        CameraView(tree, clicks(tree) + ';1,2,b999:0.5', print)
    beside = CameraView(tree, '10,10,0;600,20,1.5;30,400,2.9;bearing=0', print)
    still = picture(cv2, tree, make_simulator(tree).place())
    for _ in range(2):
        with pytest.raises(ParameterError, match='no camera fits the clicks'):
            beside.follow(0.0, still)
    view = CameraView(tree, clicks(tree), print)
    assert view.drawn() is None
    points = view.follow(0.0, still).points
    assert len(points) > 20
    shown = cv2.imdecode(np.frombuffer(view.drawn() or b'', dtype=np.uint8), cv2.IMREAD_COLOR)
    assert shown.shape == (*still.shape, 3)
    column, row = points[0].astype(int)
    blue, green, red = shown[row, column].astype(int)
    assert green > 100 + max(blue, red)
    dark = CameraView(tree, clicks(tree), print)
    assert not len(dark.follow(0.0, 0 * still).points)
    assert len(dark.follow(0.1, still).points) > 20
    with pytest.raises(ParameterError, match='640 x 479 after those of 640 x 480'):
        view.follow(0.1, still[:-1])


@pytest.mark.parametrize('source', ['no_such_film.mp4', '77'])
def test_what_has_no_picture_is_refused(cv2: Any, source: str) -> None:
    with pytest.raises(ParameterError, match='no picture comes from'):
        Film(f'camera:{source}')


def test_show_refuses_a_film_and_simulate_two(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    one = ['--motion', f'camera:{folder / "film.mp4"}', '--at', str(folder / 'clicks.txt')]
    assert main(['show', str(folder / 'tree.yaml'), *one, '--seconds', '1']) == 2
    assert 'is of the past' in capsys.readouterr().err
    words = ['simulate', str(folder / 'tree.yaml'), *one, *one]
    assert main([*words, '-o', str(folder / 'x.csv')]) == 2
    assert 'two cameras' in capsys.readouterr().err


def test_without_opencv_the_cure_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    def missing(modules: list[str], command: str) -> None:
        raise MissingDependencyError(f'{modules} for {command}')

    monkeypatch.setattr(camera_view, 'refuse_missing', missing)
    with pytest.raises(MissingDependencyError, match=r'cv2.*camera:0'):
        Film('camera:0')
