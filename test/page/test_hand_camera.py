# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A film of a drawn tree that a browser takes for a visitor's camera moves that of the page."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine, Iterator
import os
from pathlib import Path
import time
from typing import Any, NamedTuple

import numpy as np
import pytest

pytest.importorskip('aiohttp', reason='aiohttp is not installed')

from tree_sway_lab.browser import Browser, Chromium, chromium  # noqa: E402

from test.kit.filmed_pictures import CAMERA, picture, spruce  # noqa: E402
from tree_sway.core.arrays import Floats  # noqa: E402
from tree_sway.core.run import SwaySimulator  # noqa: E402
from tree_sway.core.scene import make_simulator  # noqa: E402
from tree_sway.live import PageFilm  # noqa: E402
from tree_sway.live.motion.motion_feed import MotionFeed  # noqa: E402
from tree_sway.page import PageServer, PageSettings, RATE  # noqa: E402
from tree_sway.page.session import Choices, Session  # noqa: E402
from tree_sway.simulation import RecordedWind  # noqa: E402
from tree_sway.stream import ControlPanel, PAUSE_AND_RESET  # noqa: E402
from tree_sway.twin.camera import FilmedTree  # noqa: E402

pytestmark = pytest.mark.long
FILM_RATE, PERIOD = 30, 4
DEADLINE = 120.0
_FLAGS = '--use-fake-device-for-media-stream', '--use-fake-ui-for-media-stream'
WORDS = (
    "import('/static/words.js').then((m) => Object.fromEntries("
    "['NotAllowedError', 'NotFoundError', 'camera_gone'].map((each) => [each, m.word(each)])))"
)
VIEW = "document.getElementById('seen')"
SAID = "document.getElementById('camera-said').textContent"


class Drawn(NamedTuple):
    """A film of one period of sway, and where the tip of the stem is in each picture [m]."""

    path: Path
    tips: Floats


@pytest.fixture(scope='module')
def film(tmp_path_factory: pytest.TempPathFactory) -> Drawn:
    """Draw a spruce in a wind that swells and falls; the film begins again where it ends."""
    cv2 = pytest.importorskip('cv2', reason='needs OpenCV: pip install .[camera]')
    tree = spruce()
    true = make_simulator(tree)
    tips, pictures = [], []
    for k in range(3 * PERIOD * FILM_RATE):
        for half in range(2):
            turn = 2.0 * np.pi * (k + 0.5 * half) / (PERIOD * FILM_RATE)
            true.step([7.0 + 7.0 * np.sin(turn), 0.0, 0.0], 0.5 / FILM_RATE)
        if k >= 2 * PERIOD * FILM_RATE:
            tips.append(true.tip_displacement)
            drawn = cv2.cvtColor(picture(cv2, tree, true.place()), cv2.COLOR_GRAY2BGR)
            coded = cv2.imencode('.jpg', drawn, [cv2.IMWRITE_JPEG_QUALITY, 95])[1]
            pictures.append(coded.tobytes())
    path = tmp_path_factory.mktemp('film') / 'film.mjpeg'
    path.write_bytes(b''.join(pictures))
    return Drawn(path, np.array(tips))


class Page(NamedTuple):
    """A served page, and the tree that it shows."""

    server: PageServer
    session: Session
    film: PageFilm

    @property
    def twin(self) -> FilmedTree:
        """The tree."""
        assert isinstance(self.session.simulator, FilmedTree)
        return self.session.simulator


@pytest.fixture
def page() -> Iterator[Page]:
    """Serve a spruce in calm air that waits for the camera of a page."""
    tree = spruce()
    feed = MotionFeed()
    filmed = PageFilm(tree, 'bearing=0; distance=6', print)
    feed.film = filmed
    wind = RecordedWind(np.arange(1000.0), np.zeros((1000, 3)))
    session = Session(lambda _: FilmedTree(tree, rate=RATE), Choices('spruce'), wind, motion=feed)
    panel = ControlPanel(PAUSE_AND_RESET, session.apply, session.pull)
    with PageServer(PageSettings(port=0), panel, session.status, film=filmed) as server:
        session.serve(server)
        yield Page(server, session, filmed)
        session.stop()


Script = Callable[[Browser], Coroutine[Any, Any, None]]


def visit(page: Page, script: Script, *flags: str) -> None:
    """Run a script on the page in a browser with flags of its own."""
    if chromium() is None:
        pytest.skip('chromium is not installed here')
    shared = Chromium(*flags)

    async def look() -> None:
        async with Browser(shared, scale=0.5) as browser:
            await browser.open(page.server.url)
            await browser.until('window.treeSway?.stream.description')
            await browser.until("!document.getElementById('own-camera').hidden")
            await browser.run("document.getElementById('panel').open = true")
            await browser.run("document.getElementById('camera').open = true")
            await script(browser)
            assert browser.console == []

    try:
        asyncio.run(look())
    finally:
        shared.close()


async def start(browser: Browser) -> None:
    """Start the camera as a visitor does."""
    await browser.run("document.getElementById('own-camera').click()")


async def click(browser: Browser, point: Floats) -> None:
    """Click a place in the camera's picture."""
    x, y = point.tolist()
    await browser.run(
        f"""(() => {{
          const canvas = {VIEW}, box = canvas.getBoundingClientRect();
          const [x, y] = [{x}, {y}].map((each) => each * box.width / canvas.width);
          const at = {{ clientX: box.x + x, clientY: box.y + y }};
          canvas.dispatchEvent(new MouseEvent("click", at));
        }})()"""
    )


async def point_at(browser: Browser, segment: int) -> int:
    """Click a segment of the drawn tree; returns the one that was under the pointer."""
    return int(
        await browser.run(
            f"""(() => {{
              const {{ scene }} = treeSway, {{ canvas }} = scene;
              const [x, y] = scene.camera.project(scene.position({segment}));
              const at = {{ clientX: x * canvas.clientWidth, clientY: y * canvas.clientHeight }};
              canvas.dispatchEvent(new PointerEvent("pointerdown", {{ ...at, pointerId: 1 }}));
              canvas.dispatchEvent(new PointerEvent("pointerup", {{ ...at, pointerId: 1 }}));
              canvas.dispatchEvent(new MouseEvent("click", at));
              return scene.under(at).segment;
            }})()"""
        )
    )


def test_the_film_before_a_visitors_camera_moves_the_tree(page: Page, film: Drawn) -> None:
    tree = spruce()
    stem = int(tree.branch_first[1])

    async def script(browser: Browser) -> None:
        await start(browser)
        await browser.until(f'{VIEW}.width === 640', DEADLINE)
        assert 'foot of the stem' in await browser.run(SAID)
        await click(browser, CAMERA.project(tree.start[:1])[0])
        assert 'top of the stem' in await browser.run(SAID)
        await click(browser, CAMERA.project(tree.end[stem - 1 : stem])[0])
        for share in (0.3, 0.6, 0.8):
            segment = await point_at(browser, round(share * stem))
            assert segment >= 0
            middle = 0.5 * (tree.start + tree.end)[segment]
            await click(browser, CAMERA.project(middle[None])[0])
        await browser.until(f"{SAID}.includes('clicks miss by')", DEADLINE)
        end = time.monotonic() + DEADLINE
        while not page.twin.sees:
            assert time.monotonic() < end, page.session.status()['motion']
            await asyncio.sleep(0.05)
        begun, tips = page.session._now, []
        while page.session._now < begun + 3 * PERIOD:
            assert time.monotonic() < end
            tips.append([page.session._now, float(page.twin.tip_displacement[0])])
            await asyncio.sleep(0.02)
        if (folder := os.environ.get('PICTURES')) is not None:
            Path(folder, 'hand_camera.png').write_bytes(await browser.screenshot())
        motion = page.session.status()['motion']
        assert isinstance(motion, dict)
        print(motion['said'])
        assert motion['said'][0][:2] == ['sensor_followed', 'camera:page']
        times, found = np.array(tips).T
        there = swing(np.arange(len(film.tips)) / FILM_RATE, film.tips[:, 0])
        here = swing(times[times > begun + PERIOD], found[times > begun + PERIOD])
        print(f'swing {here:.4f} m, of the film {there:.4f} m, {page.film.rate:.0f} pictures a s')
        assert 0.7 < here / there < 1.3
        await start(browser)
        assert 'no page films' in page.film.problem

    visit(page, script, *_FLAGS, f'--use-file-for-fake-video-capture={film.path}')


def swing(times: Floats, values: Floats) -> float:
    """Amplitude of the part of a motion that has the period of the film."""
    turn = 2.0 * np.pi * times / PERIOD
    basis = np.column_stack([np.ones_like(turn), np.cos(turn), np.sin(turn)])
    return float(np.hypot(*np.linalg.lstsq(basis, values, rcond=None)[0][1:]))


def test_a_refused_and_a_missing_camera_are_told_and_the_page_goes_on(page: Page) -> None:
    async def refused(browser: Browser) -> None:
        await start(browser)
        wanted = (await browser.run(WORDS))['NotAllowedError']
        await browser.until(f"document.getElementById('toast').textContent === '{wanted}'")
        assert await browser.run('treeSway.hands.film.video') is None

    async def missing(browser: Browser) -> None:
        await browser.run(
            'navigator.mediaDevices.getUserMedia = () =>'
            " Promise.reject(new DOMException('none', 'NotFoundError'))"
        )
        await start(browser)
        wanted = (await browser.run(WORDS))['NotFoundError']
        await browser.until(f"document.getElementById('toast').textContent === '{wanted}'")
        await browser.run("Object.defineProperty(navigator, 'mediaDevices', { value: undefined })")
        await start(browser)
        await browser.until("document.getElementById('toast').textContent.includes('https')")

    visit(page, refused, '--use-fake-device-for-media-stream', '--deny-permission-prompts')
    visit(page, missing, *_FLAGS)
    assert 'no page films' in page.film.problem


def test_a_camera_that_is_taken_away_and_a_closed_page_are_told(page: Page) -> None:
    async def script(browser: Browser) -> None:
        await start(browser)
        await browser.until('treeSway.hands.film?.video?.videoWidth', DEADLINE)
        await browser.run(
            "treeSway.hands.film.video.srcObject.getTracks()[0].dispatchEvent(new Event('ended'))"
        )
        gone = (await browser.run(WORDS))['camera_gone']
        await browser.until(f"{SAID} === '{gone}'")
        assert await browser.run('treeSway.hands.film.video') is None
        await start(browser)
        await browser.until('treeSway.hands.film.video?.videoWidth', DEADLINE)
        for point in ([100.0, 100.0], [200.0, 100.0]):
            await click(browser, np.array(point))
        await point_at(browser, 3)
        await click(browser, np.array([300.0, 300.0]))
        await browser.until("document.getElementById('toast').textContent.includes('clicks')")
        assert 'are to be clicked' in page.film.problem

    visit(page, script, *_FLAGS)
    end = time.monotonic() + DEADLINE
    while 'no page films' not in page.film.problem:
        assert time.monotonic() < end
        time.sleep(0.02)
    assert page.session.failure is None


def test_a_slow_drawing_leaves_every_other_frame_to_the_camera(page: Page) -> None:
    async def count(browser: Browser) -> tuple[int, int]:
        """Return a number of frames, and in how many of them the tree was drawn."""
        await browser.run(
            """(() => {
              window.frames = window.drawn = 0;
              requestAnimationFrame(function count() {
                frames += 1;
                if (drawn < 30) requestAnimationFrame(count);
              });
            })()"""
        )
        await browser.until('drawn >= 30', DEADLINE)
        frames, drawn = await browser.run('[frames, drawn]')
        return frames, drawn

    async def script(browser: Browser) -> None:
        await browser.run(
            """treeSway.scene.draw = () => {
              window.drawn += 1;
              for (const end = performance.now() + 60; performance.now() < end;);
            }"""
        )
        await browser.until('0 < treeSway.fps && treeSway.fps < 20', DEADLINE)
        frames, drawn = await count(browser)
        assert frames <= drawn + 2
        await start(browser)
        await browser.until('treeSway.hands.film?.video?.videoWidth', DEADLINE)
        frames, drawn = await count(browser)
        assert 1.8 * drawn < frames < 2.2 * drawn

    visit(page, script, *_FLAGS)


def test_a_second_camera_is_ended_and_told(page: Page) -> None:
    other = object()
    page.film.take(other, {'at': '', 'size': [640, 480]}, lambda _: None)

    async def script(browser: Browser) -> None:
        await start(browser)
        await browser.until('treeSway.hands.film?.video?.videoWidth', DEADLINE)
        page.film.take(other, {'at': '', 'size': [640, 480]}, lambda _: None)
        for point in ([100.0, 100.0], [200.0, 100.0]):
            await click(browser, np.array(point))
        await point_at(browser, 3)
        await click(browser, np.array([300.0, 300.0]))
        await browser.until(
            "document.getElementById('toast').textContent.includes('another page')"
        )
        assert await browser.run('treeSway.hands.film.video') is None
        assert page.film.refused == 3  # two of the other page without clicks, and its own, once

    visit(page, script, *_FLAGS)


def test_a_viewer_and_a_page_without_camera_get_no_button(page: Page) -> None:
    assert isinstance(page.session.simulator, SwaySimulator)
    token = 'a token of some length'
    settings = PageSettings(port=0, token=token)
    with PageServer(settings, ControlPanel((), page.session.apply), film=page.film) as server:

        async def hello(given: str) -> Any:
            import aiohttp

            headers = {'Authorization': f'Bearer {given}'}
            async with aiohttp.ClientSession(headers=headers) as session:
                async with session.get(server.url) as answer:
                    assert 'camera=(self)' in answer.headers['Permissions-Policy']
                async with session.ws_connect(f'{server.url}stream') as line:
                    told = (await line.receive_json(timeout=DEADLINE))['hello']['can_film']
                    await line.send_json({'film': {'at': '', 'size': [640, 480]}})
                    while not (answered := await line.receive_json(timeout=DEADLINE)).get(
                        'refused'
                    ):
                        pass
                    return told, answered['refused']['name']

        assert asyncio.run(hello(token)) == (True, 'clicks')
        assert asyncio.run(hello(server.viewers_token)) == (False, 'film')
