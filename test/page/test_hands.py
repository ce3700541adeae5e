# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Hands on the page, in a real browser: a branch is dragged and let go, a headset, a sound."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
import shutil
import subprocess
from typing import Any

import numpy as np
import pytest

pytest.importorskip('aiohttp', reason='aiohttp is not installed')

from tree_sway.commands.cli import main  # noqa: E402
from tree_sway.core.scene.scene import Scene  # noqa: E402
from tree_sway.core.settings import Settings  # noqa: E402
from tree_sway.files.trees.source import open_scene  # noqa: E402
from tree_sway.page.page_settings import PageSettings  # noqa: E402
from tree_sway.page.server import PageServer  # noqa: E402
from tree_sway.page.session import Choices, Session  # noqa: E402
from tree_sway.simulation.wind_source import SimulatedWind  # noqa: E402
from tree_sway.stream.controls import ControlPanel  # noqa: E402

Browser = Any
LIVE = "window.treeSway && treeSway.state === 'live' && treeSway.fps > 0"
PULL = 'treeSway.hands.drag.pull'
ATTEMPTS, LARGEST_GAP = 24, 0.06
MOVED = (
    '((s) => Math.hypot(...treeSway.scene.position(s).map((x, c) => x -'
    ' treeSway.scene.restPosition(s)[c])))({})'
)


@pytest.fixture(scope='module')
def simulator() -> Any:
    """One tree for all tests."""
    return open_scene('goldcrest').simulator(Settings(), model=20)


@contextmanager
def served(simulator: Any) -> Iterator[str]:
    """Address of a page in calm air where branches may be pulled."""
    session = Session(lambda _: simulator, Choices('goldcrest'), SimulatedWind(0.0))
    panel = ControlPanel((), session.apply, session.pull)
    with PageServer(PageSettings(port=0), panel, session.status) as server:
        session.serve(server)
        yield server.url
        session.stop()
    assert session.failure is None


@pytest.fixture(scope='module')
def live(simulator: Any) -> Iterator[str]:
    """Address of a page of the tree."""
    with served(simulator) as url:
        yield url


@pytest.fixture(scope='module')
def stand() -> Iterator[str]:
    """Address of a page of two such trees, of which the second is watched: it stands higher."""
    one = open_scene('goldcrest').trees[0]
    two = replace(one, name='higher', x=3.0, y=1.0, z=0.2, yaw=0.7)
    with served(Scene([one, two]).simulator(Settings(model=20))) as url:
        yield url


@pytest.fixture(scope='module')
def file(tmp_path_factory: pytest.TempPathFactory) -> str:
    """Address of the tree as one file."""
    path = tmp_path_factory.mktemp('one') / 'goldcrest.html'
    assert main(['convert', 'goldcrest', '--model', '20', '-o', str(path)]) == 0
    return path.as_uri()


def visit(
    browser_class: Any,
    url: str,
    script: Callable[[Browser], Coroutine[Any, Any, None]],
    before: str = '',
) -> None:
    async def whole() -> None:
        async with browser_class() as browser:
            if before:
                await browser.call('Page.addScriptToEvaluateOnNewDocument', source=before)
            await browser.open(url)
            await browser.until(LIVE)
            await script(browser)
            assert browser.console == []

    asyncio.run(whole())


async def mouse(browser: Browser, kind: str, x: float, y: float) -> None:
    await browser.call(
        'Input.dispatchMouseEvent', type=f'mouse{kind}', x=x, y=y, button='left', buttons=1,
        clickCount=1,
    )  # fmt: skip


async def click(browser: Browser, name: str) -> None:
    """Click on a button as a person does."""
    x, y = await browser.run(
        f"(b => [b.x + b.width / 2, b.y + b.height / 2])(document.getElementById('{name}')"
        '.getBoundingClientRect())'
    )
    await mouse(browser, 'Pressed', x, y)
    await mouse(browser, 'Released', x, y)


async def grab(browser: Browser) -> tuple[float, float]:
    """Press on the stem at some height; where."""
    await browser.until("!document.getElementById('pull').hidden")
    is_on = "document.getElementById('pull').getAttribute('aria-pressed') === 'true'"
    if not await browser.run(is_on):
        await click(browser, 'pull')
    await browser.until(is_on)
    x, y = await browser.run(
        'treeSway.scene.camera.project(treeSway.scene.position(9)).map((each, c) =>'
        ' each * [innerWidth, innerHeight][c])'
    )
    await mouse(browser, 'Pressed', x, y)
    await browser.until(f'{PULL}?.isHeld')
    return x, y


async def pull_and_let_go(browser: Browser) -> str:
    """Return the record of the free decay, as the page saves it."""
    azimuth = await browser.run('treeSway.scene.camera.azimuth')
    x, y = await grab(browser)
    await mouse(browser, 'Moved', x + 120, y + 10)
    moved = MOVED.format(f'{PULL}.segment')
    await browser.until(f'{PULL}.force > 0.01 && {moved} > 0.02')
    label = "document.getElementById('pull-force')"
    await browser.until(f'!{label}.hidden && / k?N$/.test({label}.textContent)')
    shown = float((await browser.run(f'{label}.textContent')).split()[0])
    # It swings on the spring, too: let go where it is far over.
    await browser.until(f'{moved} > 0.02')
    await mouse(browser, 'Released', x + 120, y + 10)
    assert shown > 0.01
    assert await browser.run('treeSway.scene.camera.azimuth') == azimuth
    await browser.until(f"{PULL}.seconds > 3 && !document.getElementById('pull-save').hidden")
    assert await browser.run(f'{label}.hidden')
    return str(await browser.run(f'{PULL}.csv()'))


@pytest.mark.parametrize(
    'kind', ['live', *(pytest.param(k, marks=pytest.mark.long) for k in ('stand', 'file'))]
)
def test_a_branch_that_is_dragged_follows_and_swings_when_let_go(
    kind: str, request: pytest.FixtureRequest, swift_browser_class: Any, tmp_path: Path
) -> None:
    async def script(browser: Browser) -> None:
        if kind == 'file':
            await browser.run("treeSway.stream.set('mean_speed', 0)")
            await browser.run("document.getElementById('control-reset').click()")
        # A machine with other work loses frames: calibrate asks for a record without gaps.
        for _ in range(ATTEMPTS):
            rows = await pull_and_let_go(browser)
            times = [float(row.split(',')[0]) for row in rows.splitlines()[1:]]
            if np.diff(times).max() < LARGEST_GAP:
                break
        (tmp_path / 'pull_test.csv').write_text(rows, encoding='utf-8')

    visit(swift_browser_class, request.getfixturevalue(kind), script)
    record = np.loadtxt(tmp_path / 'pull_test.csv', delimiter=',', skiprows=1)
    swing = np.linalg.norm(record[:, 1:], axis=1)
    assert swing[record[:, 0] < 1.0].max() > 0.01
    assert swing[-20:].max() < 0.5 * swing[:20].max()
    command = ['calibrate', 'goldcrest', '--record', str(tmp_path / 'pull_test.csv')]
    assert main([*command, '-o', str(tmp_path / 'fitted.yaml')]) == 0
    before, found = [
        open_scene(name).trees[0].species for name in ('goldcrest', str(tmp_path / 'fitted.yaml'))
    ]
    assert found.modulus == pytest.approx(before.modulus, rel=0.05)
    assert found.damping_in_leaf == pytest.approx(before.damping_in_leaf, rel=0.2)


def test_who_may_not_set_controls_may_not_pull(simulator: Any, browser_class: Any) -> None:
    session = Session(lambda _: simulator, Choices('goldcrest'), SimulatedWind(0.0))
    with PageServer(PageSettings(port=0)) as server:
        session.serve(server)

        async def script(browser: Browser) -> None:
            assert await browser.run("document.getElementById('pull').hidden")
            pull = '{segment: 9, to: [1, 0, 1], stiffness: 5}'
            await browser.run(f'treeSway.stream.pull({pull})')
            await browser.until("document.getElementById('toast').hidden === false")
            assert 'can be pulled' in await browser.run(
                "document.getElementById('toast').innerText"
            )

        visit(browser_class, server.url, script)
        assert server.n_refused == 1
        session.stop()


def test_another_tree_of_a_stand_is_pulled_where_it_is_grabbed(
    stand: str, browser_class: Any
) -> None:
    async def script(browser: Browser) -> None:
        assert await browser.run('treeSway.scene.detail.watched') == 1
        await browser.until("!document.getElementById('pull').hidden")
        await click(browser, 'pull')
        await browser.until(
            "document.getElementById('pull').getAttribute('aria-pressed') === 'true'"
        )
        x, y = await browser.run(
            '(({scene}) => { scene.detail.watched = 0; const at = scene.position(9);'
            ' scene.detail.watched = 1; return scene.camera.project(at).map((each, c) =>'
            ' each * [innerWidth, innerHeight][c]); })(treeSway)'
        )
        await mouse(browser, 'Pressed', x, y)
        await browser.until(f'{PULL}?.isHeld')
        assert await browser.run('treeSway.scene.detail.watched') == 0
        await mouse(browser, 'Moved', x + 120, y + 10)
        await browser.until(f'{PULL}.force > 0.01 && {MOVED.format(f"{PULL}.segment")} > 0.02')
        await mouse(browser, 'Released', x + 120, y + 10)

    visit(browser_class, stand, script)


def test_a_pull_that_cannot_be_is_refused_and_said(live: str, browser_class: Any) -> None:
    async def script(browser: Browser) -> None:
        await browser.run('treeSway.stream.pull({segment: 1e6, to: [1, 0, 1], stiffness: 5})')
        await browser.until("document.getElementById('toast').hidden === false")
        assert 'no segment 1000000' in await browser.run(
            "document.getElementById('toast').innerText"
        )

    visit(browser_class, live, script)


def test_the_wind_is_heard_once_it_is_asked_for(file: str, browser_class: Any) -> None:
    async def loudness(browser: Browser, speed: float) -> float:
        """Root mean square of what is heard in a wind."""
        await browser.run(f"treeSway.stream.set('mean_speed', {speed})")
        await browser.run("treeSway.stream.set('intensity', 0)")
        await browser.until(f'Math.abs(Math.hypot(...treeSway.playout.wind) - {speed}) < 0.3')
        begin = await browser.run('treeSway.hands.sound.context.currentTime')
        await browser.until(f'treeSway.hands.sound.context.currentTime > {begin} + 1.5')
        return float(
            await browser.run(
                '(() => { const heard = new Float32Array(32768);'
                ' ear.getFloatTimeDomainData(heard);'
                ' return Math.sqrt(heard.reduce((s, x) => s + x * x, 0) / heard.length); })()'
            )
        )

    async def script(browser: Browser) -> None:
        assert await browser.run('treeSway.hands.sound === null')
        await click(browser, 'sound')
        await browser.until("treeSway.hands.sound?.context.state === 'running'")
        await browser.run(
            'window.ear = new AnalyserNode(treeSway.hands.sound.context, {fftSize: 32768});'
            ' treeSway.hands.sound.out.connect(ear); null'
        )
        calm, storm = [await loudness(browser, speed) for speed in (2.0, 15.0)]
        print(f'heard: {calm:.4f} at 2 m/s, {storm:.4f} at 15 m/s')
        assert storm > 5.0 * calm > 0.0
        await click(browser, 'sound')
        await browser.until("treeSway.hands.sound.context.state === 'suspended'")

    visit(browser_class, file, script)


@pytest.fixture(scope='module')
def emulator(tmp_path_factory: pytest.TempPathFactory) -> str:
    """Script of Meta's emulator of headsets, from npm."""
    npm = shutil.which('npm')
    if npm is None:
        pytest.skip('npm is not installed here')
    folder = tmp_path_factory.mktemp('npm')
    command = [npm, 'install', '--no-audit', '--no-fund', '--prefix', str(folder), 'iwer@2']
    if subprocess.run(command, capture_output=True, timeout=180).returncode:
        pytest.skip('npm cannot bring the emulator of headsets here')
    script = (folder / 'node_modules' / 'iwer' / 'build' / 'iwer.min.js').read_text('utf-8')
    return (
        f'{script};\nwindow.device = new IWER.XRDevice(IWER.metaQuest3);'
        'device.installRuntime({forceInstall: true}); device.ipd = 0.063;'
        'device.stereoEnabled = true;'
        # The emulator takes an offset for its matrix.
        '{const own = XRReferenceSpace.prototype.getOffsetReferenceSpace;'
        ' XRReferenceSpace.prototype.getOffsetReferenceSpace = function (offset) {'
        ' return own.call(this, Object.assign(offset.matrix, {matrix: offset.matrix})); };}'
    )


def test_a_headset_shows_the_tree_and_pulls_a_branch(
    emulator: str, file: str, browser_class: Any
) -> None:
    aim = (
        # From the rig's frame to the scene and back: a ray through the place of a segment.
        '(() => {const h = treeSway.hands.headset;'
        ' const [c, s] = [Math.cos(h.heading), Math.sin(h.heading)];'
        ' const p = treeSway.scene.position(9).map((x, i) => x - h.origin[i]);'
        ' const goal = [s * p[0] - c * p[1], p[2], -(c * p[0] + s * p[1])];'
        ' const hand = device.controllers.right; hand.position.set(0.2, 1, 0);'
        ' const d = [goal[0] - 0.2, goal[1] - 1, goal[2]]; const n = Math.hypot(...d);'
        ' const [x, y, z] = d.map((e) => e / n);'
        # The turn that takes -z to this direction.
        ' const w = 1 - z, q = [y, -x, 0]; const m = Math.hypot(...q, w);'
        ' hand.quaternion.set(q[0] / m, q[1] / m, 0, w / m);})()'
    )

    async def script(browser: Browser) -> None:
        await browser.run("treeSway.stream.set('mean_speed', 0)")
        await browser.until("!document.getElementById('headset').hidden")
        await click(browser, 'headset')
        await browser.until('treeSway.hands.headset?.frames > 5')
        views = 'treeSway.hands.headset.views'
        (left, _, *size), (right, *_) = await browser.run(f'{views}.map(({{area}}) => area)')
        assert right == left + size[0] > left  # two eyes side by side
        apart = f'Math.hypot(...{views}[0].camera.eye.map((x, c) => x - {views}[1].camera.eye[c]))'
        assert await browser.run(apart) == pytest.approx(0.063, abs=1e-3)
        origin = await browser.run('treeSway.hands.headset.origin')
        await browser.run(aim)
        frames = await browser.run('treeSway.hands.headset.frames')
        await browser.until(f'treeSway.hands.headset.frames > {frames} + 3')
        await browser.run("device.controllers.right.updateButtonValue('squeeze', 1)")
        await browser.until('treeSway.hands.headset.pulls.size === 1')
        pull = '[...treeSway.hands.headset.pulls.values()][0].pull'
        await browser.run('device.controllers.right.position.set(0.5, 1, 0)')
        await browser.until(f'{pull}.force > 0.01 && {MOVED.format(f"{pull}.segment")} > 0.02')
        await browser.run("device.controllers.right.updateButtonValue('squeeze', 0)")
        await browser.until('treeSway.hands.headset.pulls.size === 0')
        # Down at the floor: the trigger goes there.
        await browser.run(
            'device.controllers.right.quaternion.set(-0.38, 0, 0, 0.92);'
            "device.controllers.right.updateButtonValue('trigger', 1)"
        )
        frames = await browser.run('treeSway.hands.headset.frames')
        await browser.until(f'treeSway.hands.headset.frames > {frames} + 3')
        await browser.run("device.controllers.right.updateButtonValue('trigger', 0)")
        await browser.until(
            f'Math.hypot(...treeSway.hands.headset.origin.map((x, c) => x - {origin}[c])) > 0.3'
        )
        await browser.run('device.activeSession.end()')
        await browser.until('treeSway.hands.headset.session === null')
        await browser.until(LIVE)

    visit(browser_class, file, script, emulator)
