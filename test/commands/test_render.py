# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``tree-sway render``: a tree in wind as a moving picture."""

from __future__ import annotations

from pathlib import Path
import sys

import numpy as np
import pytest

Image = pytest.importorskip('PIL.Image', reason='Pillow is not installed')

from tree_sway.commands.cli import main  # noqa: E402

FILES = Path(__file__).parents[1] / 'files' / 'data'
SEEDLING = str(FILES / 'seedling.yaml')


def frame(path: Path, number: int = 0) -> np.ndarray:
    """Return a frame of a picture as (h, w, 3)."""
    image = Image.open(path)
    image.seek(number)
    return np.asarray(image.convert('RGB')).astype(float)


def test_a_gif_of_a_recorded_wind_moves(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / 'sway.gif'
    given = ['render', SEEDLING, '--wind', str(FILES / 'wind.csv'), '--seconds', '2']
    assert main([*given, '--rate', '10', '--pixels', '160', '-o', str(path)]) == 0
    assert '20 pictures, 2 s of wind in' in capsys.readouterr().out
    image = Image.open(path)
    # Frames that are equal are written as one of their length.
    frames = [
        each.info['duration'] for each in (image.seek(k) or image for k in range(image.n_frames))
    ]
    assert sum(frames) == 2000
    assert 10 <= len(frames) <= 20
    assert np.abs(frame(path, len(frames) - 3) - frame(path, 1)).max() > 60


def test_the_same_command_gives_the_same_film(tmp_path: Path) -> None:
    given = ['render', SEEDLING, '--seconds', '0.5', '--rate', '8', '--pixels', '120']
    films = [tmp_path / f'{name}.gif' for name in ('one', 'two')]
    for film in films:
        assert main([*given, '--speed', '9', '-o', str(film)]) == 0
    assert Image.open(films[0]).n_frames == 4
    assert films[0].read_bytes() == films[1].read_bytes()


def test_a_film_is_written_by_the_wheel(tmp_path: Path) -> None:
    pytest.importorskip('imageio_ffmpeg', reason='imageio-ffmpeg is not installed')
    path = tmp_path / 'sway.mp4'
    assert main(['render', SEEDLING, '--seconds', '1', '--pixels', '96', '-o', str(path)]) == 0
    assert path.read_bytes()[4:8] == b'ftyp'


def test_a_film_that_cannot_be_is_refused_before_the_tree_is_opened(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, 'imageio_ffmpeg', None)
    assert main(['render', 'no such tree', '-o', str(tmp_path / 'sway.mp4')]) == 2
    assert 'pip install "tree_sway_ros[film]"' in capsys.readouterr().err


@pytest.mark.parametrize(
    ('arguments', 'told'),
    [
        (['-o', 'a.jpg'], 'no moving picture'),
        (['-o', 'a.gif', '--rate', '0'], '--rate'),
        (['-o', 'a.gif', '--seconds', '1e9'], '--seconds'),
        (['-o', 'a.gif', '--speed', '-3'], 'out of range'),
    ],
)
def test_what_cannot_be_rendered_is_refused(
    arguments: list[str], told: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(['render', SEEDLING, '--pixels', '64', *arguments]) == 2
    assert told in capsys.readouterr().err
