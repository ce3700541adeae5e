# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``tree-sway render``: a tree in wind as a moving picture."""

from __future__ import annotations

from pathlib import Path
import sys

import numpy as np
import pytest

Image = pytest.importorskip('PIL.Image', reason='Pillow is not installed')

from tree_sway import extras  # noqa: E402
from tree_sway.commands.cli import main  # noqa: E402
from tree_sway.page import film  # noqa: E402
from tree_sway.page.film import browser  # noqa: E402
from tree_sway.pictures.commands import render  # noqa: E402

FILES = Path(__file__).parents[2] / 'files' / 'data'
SEEDLING = str(FILES / 'seedling.yaml')


@pytest.fixture
def plainly(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let there be no browser, which takes seconds to start."""
    monkeypatch.setattr(render, 'browser', lambda: None)


def frame(path: Path, number: int = 0) -> np.ndarray:
    """Return a frame of a picture as (h, w, 3)."""
    image = Image.open(path)
    image.seek(number)
    return np.asarray(image.convert('RGB')).astype(float)


@pytest.mark.browser
@pytest.mark.skipif(browser() is None, reason='chromium is not installed here')
def test_a_film_is_the_picture_of_the_page(tmp_path: Path) -> None:
    path = tmp_path / 'sway.gif'
    given = ['render', SEEDLING, '--speed', '12', '--seconds', '0.6', '--rate', '5']
    assert main([*given, '--pixels', '200', '-o', str(path)]) == 0
    image = Image.open(path)
    assert image.size == (320, 200)
    assert image.n_frames == 3
    first, last = frame(path), frame(path, 2)
    sky, ground = first[:10].mean(axis=(0, 1)), first[-10:].mean(axis=(0, 1))
    assert sky[2] > sky[0] + 10.0
    assert np.abs(sky - ground).max() > 20.0
    tree = np.abs(first[:, :80] - last[:, :80]).max(), np.abs(first - last)[:, 120:200].max()
    assert tree[1] > tree[0]


@pytest.mark.parametrize(
    ('lasts', 'patience', 'expected'),
    [('exec sleep 60', 0.2, 'drew nothing'), ('exit 7', 60.0, 'ended with status 7')],
)
def test_a_browser_that_draws_nothing_or_ends_is_named(
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    lasts: str,
    patience: float,
    expected: str,
) -> None:
    program = tmp_path / 'browser'
    program.write_text(f'#!/bin/sh\n{lasts}\n')
    program.chmod(0o700)
    monkeypatch.setattr(film, 'browser', lambda: str(program))
    monkeypatch.setattr(film, '_PATIENCE', patience)
    monkeypatch.setattr(render, 'browser', film.browser)
    target = tmp_path / 'sway.gif'
    assert main(['render', SEEDLING, '--seconds', '0.2', '-o', str(target)]) == 2
    assert expected in capsys.readouterr().err
    assert not target.exists()


def test_a_film_that_takes_long_says_so_after_three_pictures(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    now = iter([20.0, 22.0, 24.0, 25.0])  # the first picture came after 20 s
    monkeypatch.setattr(render.time, 'monotonic', lambda: next(now))
    pictures = [b'1', b'2', b'3', b'4']
    told = render._with_forecast(iter(pictures), 80)
    assert [next(told) for _ in range(2)] == pictures[:2]
    assert capsys.readouterr().err == ''
    assert [*told] == pictures[2:]
    assert capsys.readouterr().err == (
        'note: 80 pictures take about 154 s more; '
        'a smaller --seconds, --rate or --pixels takes less\n'
    )


@pytest.mark.usefixtures('plainly')
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


@pytest.mark.usefixtures('plainly')
def test_the_same_command_gives_the_same_film(tmp_path: Path) -> None:
    given = ['render', SEEDLING, '--seconds', '0.5', '--rate', '8', '--pixels', '120']
    films = [tmp_path / f'{name}.gif' for name in ('one', 'two')]
    for each in films:
        assert main([*given, '--speed', '9', '-o', str(each)]) == 0
    assert Image.open(films[0]).n_frames == 4
    assert films[0].read_bytes() == films[1].read_bytes()


@pytest.mark.usefixtures('plainly')
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
    words = extras.cure_of_missing('imageio_ffmpeg', '').rpartition(' ')[0]
    assert words in capsys.readouterr().err


@pytest.mark.parametrize(
    ('arguments', 'message'),
    [
        (['-o', 'a.jpg'], 'no moving picture'),
        (['-o', 'a.gif', '--rate', '0'], '--rate'),
        (['-o', 'a.gif', '--seconds', '1e9'], '--seconds'),
        (['-o', 'a.gif', '--speed', '-3'], 'out of range'),
    ],
)
def test_what_cannot_be_rendered_is_refused(
    arguments: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(['render', SEEDLING, '--pixels', '64', *arguments]) == 2
    assert message in capsys.readouterr().err
