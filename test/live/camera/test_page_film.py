# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Points that a page sends of its own camera: clicks, pictures, and what is refused of them."""

from __future__ import annotations

from collections.abc import Mapping
import math
import queue
import time
from typing import Any

import numpy as np
import pytest

from test.kit.filmed_pictures import CAMERA, clicks, SIZE, spruce
from tree_sway.core.scene import make_simulator
from tree_sway.core.tree import ends_of_poses
from tree_sway.errors import ParameterError
from tree_sway.live import PageFilm
from tree_sway.live.camera import page_film
from tree_sway.live.motion.motion_feed import MotionFeed
from tree_sway.twin.camera import FilmedTree

DEADLINE = 30.0
DT = 1.0 / 60.0


class Clock:
    """The clock of this machine, by hand."""

    def __init__(self, now: float) -> None:
        self.now = now

    def monotonic(self) -> float:
        """Return the time of now [s]."""
        return self.now


class Page:
    """A page that films: its messages, and the answers that it gets."""

    def __init__(self, film: PageFilm) -> None:
        self._film = film
        self._answers = queue.Queue[Mapping[str, Any]]()

    def send(self, **message: object) -> str | None:
        """Send a message; why it is refused."""
        return self._film.take(self, message, self._answers.put)

    def click(self, text: str = '', size: object = SIZE) -> Mapping[str, Any]:
        """Send clicks, and wait for the answer."""
        assert self.send(at=text or clicks(spruce()), size=list(size)) is None  # type: ignore[call-overload]
        return self._answers.get(timeout=DEADLINE)


@pytest.fixture
def told() -> list[str]:
    return []


@pytest.fixture
def film(told: list[str]) -> PageFilm:
    return PageFilm(spruce(), 'distance=6', told.append)


def test_clicks_are_answered_by_where_the_wood_is(film: PageFilm, told: list[str]) -> None:
    assert 'no page films' in film.problem
    answer = Page(film).click()['film']
    assert answer['number'] == 1
    assert 'clicks miss by' in answer['said']
    assert 'are to be clicked' not in film.problem
    tree = spruce()
    places = np.array(answer['places'])
    assert 40 < len(places) < 1500
    middles = CAMERA.project(0.5 * (tree.start + tree.end))
    apart = np.linalg.norm(places[:, None] - middles, axis=2).min(axis=1)
    assert np.median(apart) < 4.0
    assert film.picture() is None
    assert any('clicks miss by' in each for each in told)


@pytest.mark.parametrize(
    ('text', 'why'),
    [
        ('1,2,b999:0.5;3,4,0;5,6,1', 'b999'),
        ('1,2,0;3,4,1', '2 clicked points'),
        ('10,10,0;600,20,1.5;30,400,2.9;bearing=0', 'no camera fits'),
        ('a,b', 'no clicked point'),
        ('bearing=nan', 'no number'),
        ('1e300,2,0;3,4,1;5,6,1.5;bearing=0', 'no number'),
    ],
)
def test_clicks_of_no_camera_are_refused_with_the_cause(
    film: PageFilm, text: str, why: str
) -> None:
    page = Page(film)
    refused = page.click(text)['refused']
    assert refused['name'] == 'clicks'
    assert why in refused['reason']
    assert film.refused == 1
    assert 'are to be clicked' in film.problem
    assert 'film' in page.click()


@pytest.mark.parametrize('at', ['1,2,0', 'check=x.png', 'bearing=x'])
def test_a_start_takes_no_clicks_of_other_pictures(at: str) -> None:
    with pytest.raises(ParameterError):
        PageFilm(spruce(), at, print)


@pytest.mark.parametrize(
    'message',
    [
        [], 5, None, {}, {'points': 5, 'time': 1.0}, {'points': [1.0], 'time': 1.0},
        {'points': [1.0, '2'], 'time': 1.0}, {'points': [1.0, True], 'time': 1.0},
        {'points': [1.0, math.nan], 'time': 1.0}, {'points': [1.0, 10**400], 'time': 1.0},
        {'points': [0.0], 'time': None}, {'points': [], 'time': '1'}, {'points': []},
        {'at': '', 'size': [640]}, {'at': '', 'size': [0, 480]}, {'at': '', 'size': None},
        {'at': '', 'size': [640, 480, 3]}, {'at': ''}, {'at': '', 'size': [640, '480']},
    ],
)  # fmt: skip
def test_a_message_of_another_form_is_none(film: PageFilm, message: Any) -> None:
    with pytest.raises((ValueError, TypeError)):
        film.take(message, message, print)
    assert film.drain() == []


def test_one_page_films_at_a_time_and_another_when_it_is_gone(
    film: PageFilm, monkeypatch: pytest.MonkeyPatch
) -> None:
    clock = Clock(time.monotonic())
    monkeypatch.setattr(page_film, 'time', clock)
    first, second = Page(film), Page(film)
    first.click()
    for k in range(9):
        clock.now += 0.03
        assert first.send(time=30.0 * k, number=1, points=[1.0, None]) is None
        if k > 2:
            assert 'another page films' in str(second.send(at='', size=[*SIZE]))
    film.leave(second)
    assert len(film.drain()) == 9
    first.send(end=True)
    assert 'no page films' in film.problem
    assert second.send(time=5.0, number=1, points=[1.0, 2.0]) is None
    assert film.drain() == []  # of clicks that are not its own
    number = second.click()['film']['number']
    assert second.send(time=60.0, number=number, points=[1.0, 2.0]) is None
    assert len(film.drain()) == 1
    film.leave(second)
    assert 'no page films' in film.problem


def test_points_of_other_clicks_or_another_number_of_them_are_refused(film: PageFilm) -> None:
    page = Page(film)
    page.click()
    assert page.click()['film']['number'] == 2
    given = [(1, [1.0, 2.0]), (2, [1.0, 2.0]), (2, [1.0, 2.0, 3.0, 4.0]), (2, [None, None])]
    for k, (number, points) in enumerate(given):
        page.send(time=33.0 * k, number=number, points=points)
    seen = film.drain()
    assert [each.reference for each in seen] == [2, 2]
    assert film.refused == 2
    assert np.isnan(seen[1].points).all()
    assert film.camera is not None


def test_times_are_those_of_this_machine_and_a_jump_is_refused(
    film: PageFilm, monkeypatch: pytest.MonkeyPatch
) -> None:
    page = Page(film)
    page.click()
    clock = Clock(time.monotonic())
    monkeypatch.setattr(page_film, 'time', clock)
    began = clock.now
    for k in range(60):
        clock.now = began + k / 30.0
        stamp = 1e6 + 1e3 * k / 30.0 + (1e7 if k == 40 else 0.0)
        page.send(time=stamp, number=1, points=[1.0, 2.0])
    seen = film.drain()
    assert len(seen) == 59
    assert film.refused == 1
    np.testing.assert_allclose([seen[0].time, seen[-1].time], [began, began + 59 / 30], atol=1e-6)
    assert film.rate == pytest.approx(30.0, rel=0.1)
    assert film.problem == ''
    clock.now += 5.0
    assert 'no picture comes from the page' in film.problem


def test_a_tree_follows_what_a_page_sends(film: PageFilm, monkeypatch: Any) -> None:
    """From points on the true tree, in a clock of the page's own, to the tip of the other one."""
    tree = spruce()
    page = Page(film)
    number = page.click()['film']['number']
    clock = Clock(time.monotonic())
    monkeypatch.setattr(page_film, 'time', clock)
    true = make_simulator(tree)
    twin = FilmedTree(tree, rate=60.0)
    feed = MotionFeed()
    feed.film = film
    began, tips = clock.now, []
    for k in range(8 * 60):
        clock.now = began + (k + 1) * DT
        true.step([9.0 + 5.0 * np.sin(0.033 * k), 0.0, 0.0] if k else [0.0, 0.0, 0.0], DT)
        start, end = ends_of_poses(true.place(), tree.length)
        if k % 2 == 0:
            points = CAMERA.project(0.5 * (start + end))[:: tree.n_segments // 100].round(2)
            page.send(time=1e3 * clock.now - 5e6, number=number, points=points.ravel().tolist())
        feed.feed(twin, (k + 1) * DT, clock.now)
        twin.step([0.0, 0.0, 0.0], DT)
        tips.append([true.tip_displacement[0], twin.tip_displacement[0]])
    there, found = np.array(tips)[120:].T
    assert np.sqrt(np.square(found - there).mean() / np.square(there).mean()) < 0.3
    assert twin.sees
