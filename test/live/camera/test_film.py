# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Films in files, live cameras, and what is said of those that cannot be opened."""

from __future__ import annotations

from pathlib import Path
import time
from typing import Any

import numpy as np
import pytest

from tree_sway.commands.cli import main
from tree_sway.core.scene import make_simulator
from tree_sway.core.tree import ends_of_poses
from tree_sway.errors import MissingDependencyError, ParameterError
from tree_sway.files.export import write_tree
from tree_sway.growth import grow
from tree_sway.live import Film, LiveFilm
from tree_sway.live.camera import film as film_module
from tree_sway.twin import place_on
from tree_sway.twin.camera import Camera, drawn_wood, looking

SIZE = 640, 480
RATE, SECONDS = 30, 6
CAMERA = Camera(np.array([0.0, -6.0, 1.5]), looking(0.0, 0.05, 0.0), 620.0, 0.5 * np.array(SIZE))


@pytest.fixture(scope='module')
def cv2() -> Any:
    return pytest.importorskip('cv2', reason='needs OpenCV: pip install .[camera]')


@pytest.fixture(scope='module')
def folder(tmp_path_factory: pytest.TempPathFactory, cv2: Any) -> Path:
    """Draw a film of a spruce of 3 m in gusts from the west, the tree and its clicks."""
    folder = tmp_path_factory.mktemp('film')
    tree = grow('spruce', 3.0, rng=np.random.default_rng(8))
    write_tree(folder / 'tree.yaml', tree)
    true = make_simulator(tree)
    path = str(folder / 'film.mp4')
    film = cv2.VideoWriter(path, cv2.VideoWriter_fourcc(*'mp4v'), RATE, SIZE)
    rng = np.random.default_rng(2)
    bark = 30.0 + 90.0 * rng.random(tree.n_segments)
    moved = []
    for k in range(RATE * SECONDS):
        if k:
            for _ in range(2):
                true.step([9.0 + 5.0 * np.sin(2.0 * k / RATE), 0.0, 0.0], 0.5 / RATE)
        start, end = ends_of_poses(true.place(), tree.length)
        moved.append(end[tree.branch_first[1] - 1])
        picture = np.full((SIZE[1] * 2, SIZE[0] * 2), 220, dtype=np.uint8)
        wood = drawn_wood(CAMERA, start, end, tree.base_diameter)
        for s in np.argsort(-wood.depth).tolist():
            both = [
                tuple((32 * each).astype(int).tolist()) for each in (wood.first[s], wood.last[s])
            ]
            thick = max(round(2 * float(wood.width[s])), 1)
            cv2.line(picture, *both, float(bark[s]), thick, cv2.LINE_AA, 4)
        small = cv2.resize(picture, SIZE, interpolation=cv2.INTER_AREA)
        film.write(cv2.cvtColor(small, cv2.COLOR_GRAY2BGR))
    film.release()
    np.save(folder / 'stem.npy', moved)
    lines = ['bearing=0', 'distance=6', 'height=1.5']
    for where in ('0', '0.7', '1.5', '2.2', '2.9'):
        place = place_on(tree, where)
        first, last = tree.start[place.segment], tree.end[place.segment]
        x, y = CAMERA.project((first + place.along * (last - first))[None])[0].tolist()
        lines.append(f'{x:.1f},{y:.1f},{where}')
    (folder / 'clicks.txt').write_text(';\n'.join(lines), encoding='utf-8')
    return folder


def test_simulate_follows_a_film_without_wind(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    check, sway = folder / 'check.png', folder / 'sway.csv'
    clicks = (folder / 'clicks.txt').read_text(encoding='utf-8') + f';check={check}'
    words = ['simulate', str(folder / 'tree.yaml'), '--leaves', 'off']
    words += ['--motion', f'camera:{folder / "film.mp4"}', '--at', clicks]
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
    assert film.size == SIZE
    assert not film.is_live
    tree = grow('spruce', 3.0, rng=np.random.default_rng(8))
    wood = drawn_wood(CAMERA, tree.start, tree.end, tree.base_diameter)
    told: list[str] = []
    live = LiveFilm(film, CAMERA, film.tracker(wood), told.append)
    live.start()
    seen = []
    end = time.monotonic() + 20.0
    while len(seen) < 5 and time.monotonic() < end:
        seen += live.drain()
    live.stop()
    assert len(seen) >= 5
    assert abs(seen[0].time - time.monotonic()) < 30.0
    assert any('pictures come' in each for each in told)


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

    monkeypatch.setattr(film_module, 'refuse_missing', missing)
    with pytest.raises(MissingDependencyError, match=r'cv2.*camera:0'):
        Film('camera:0')
