# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Everything on the page by keyboard alone, and named for those who hear it."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine, Iterator
import json
from typing import Any

import pytest

pytest.importorskip('aiohttp', reason='aiohttp is not installed')

from tree_sway.core.settings import Settings  # noqa: E402
from tree_sway.files.trees.source import open_scene  # noqa: E402
from tree_sway.page.page_settings import PageSettings  # noqa: E402
from tree_sway.page.server import PageServer  # noqa: E402
from tree_sway.page.session import Choices, Session  # noqa: E402
from tree_sway.simulation.wind_source import SimulatedWind  # noqa: E402
from tree_sway.stream.controls import Control, ControlPanel, PAUSE_AND_RESET  # noqa: E402

Browser = Any
LIVE = "window.treeSway && treeSway.state === 'live' && treeSway.fps > 0"
CODES = {
    'Tab': (9, ''), 'Enter': (13, '\r'), ' ': (32, ' '), 'ArrowLeft': (37, ''),
    'ArrowUp': (38, ''), 'ArrowRight': (39, ''), 'ArrowDown': (40, ''), 'Escape': (27, ''),
}  # fmt: skip
CONTROLS = (
    "[...document.querySelectorAll('button, input, select, summary, canvas[tabindex]')]"
    '.filter((e) => e.checkVisibility() && !e.disabled).map((e) => e.id || e.localName)'
)
PREPARED = (
    'window.taken = 0; HTMLAnchorElement.prototype.click = () => { taken += 1; };'
    'Element.prototype.requestFullscreen = () => { taken += 1; return Promise.resolve(); };'
)
EFFECTS = {
    'view': ('ArrowRight', 'treeSway.scene.camera.azimuth'),
    'home': ('Enter', 'treeSway.scene.camera.azimuth'),
    'leaves': ('Enter', 'treeSway.scene.leavesShown'),
    'theme': ('Enter', 'treeSway.scene.day.sun.join()'),
    'season': (' ', 'treeSway.scene.isAutumn'),
    'picture': ('Enter', 'taken'),
    'clip': (' ', "document.getElementById('clip').getAttribute('aria-pressed')"),
    'glb': ('Enter', 'taken'),
    'html': ('Enter', 'taken'),
    'link': ('Enter', 'location.hash'),
    'full': ('Enter', 'taken'),
    'help': ('Enter', "document.getElementById('keys').open"),
    'pull': (' ', 'Boolean(treeSway.hands.drag?.isOn)'),
    'sound': ('Enter', 'Boolean(treeSway.hands.sound?.isOn)'),
    'shown': ('ArrowDown', 'treeSway.traces.tip.quantity'),
    'time': ('ArrowLeft', 'treeSway.playout.back'),
    'controls-title': ('Enter', "document.getElementById('panel').open"),
    'control-mean_speed': ('ArrowRight', ''),
    'control-pause': (' ', 'treeSway.playout.isPaused'),
    'control-reset': ('Enter', ''),
}
"""Key of each control, and what is another after it; nothing where the server knows it."""


@pytest.fixture(scope='module')
def live() -> Iterator[tuple[str, SimulatedWind, list[str]]]:
    """Address of a page, its wind, and the names of the controls that were set."""
    simulator = open_scene('goldcrest').simulator(Settings(), model=12)
    wind, names = SimulatedWind(6.0), list[str]()
    session = Session(lambda _: simulator, Choices('goldcrest'), wind)

    def apply(name: str, value: Any) -> Any:
        names.append(name)
        return session.apply(name, value)

    controls = (Control('mean_speed', 'Wind', 6.0, 'Mean', 'm/s', 0.0, 40.0), *PAUSE_AND_RESET)
    panel = ControlPanel(controls, apply, session.pull)
    with PageServer(PageSettings(port=0), panel, session.status, session.written) as server:
        session.serve(server)
        yield server.url, wind, names
        session.stop()
    assert session.failure is None


def visit(
    browser_class: Any, url: str, script: Callable[[Browser], Coroutine[Any, Any, None]]
) -> None:
    async def whole() -> None:
        async with browser_class() as browser:
            await browser.open(url)
            await browser.until(LIVE)
            await script(browser)
            assert browser.console == []

    asyncio.run(whole())


async def press(browser: Browser, key: str) -> None:
    """Press a key and let it go."""
    code, text = CODES[key]
    words = {'key': key, 'code': key, 'windowsVirtualKeyCode': code}
    await browser.call('Input.dispatchKeyEvent', type='keyDown', text=text, **words)
    await browser.call('Input.dispatchKeyEvent', type='keyUp', **words)


async def focus(browser: Browser, name: str) -> None:
    """Go to a control by Tab."""
    for _ in range(60):
        at = await browser.run('document.activeElement.id || document.activeElement.localName')
        if at == name:
            return
        await press(browser, 'Tab')
    raise AssertionError(f'{name} is not reached by Tab')


def test_every_control_is_reached_and_operated_by_keys(
    live: tuple[str, SimulatedWind, list[str]], browser_class: Any
) -> None:
    url, wind, names = live
    own = {
        'control-mean_speed': lambda: wind.values['mean_speed'],
        'control-reset': lambda: names.count('reset'),
    }

    async def script(browser: Browser) -> None:
        await browser.run(PREPARED)
        await browser.until("!document.getElementById('pull').hidden")
        assert set(await browser.run(CONTROLS)) == set(EFFECTS)
        for name, (key, effect) in EFFECTS.items():
            await focus(browser, name)
            value = own.get(name)
            before = value() if value else await browser.run(effect)
            await press(browser, key)
            if value:
                async with asyncio.timeout(30.0):
                    while value() == before:
                        await browser.run('new Promise(requestAnimationFrame)')
            else:
                await browser.until(f'({effect}) !== {json.dumps(before)}')
            if name == 'help':
                await focus(browser, 'language')
                await press(browser, 'ArrowDown')
                assert await browser.run('document.documentElement.lang') == 'de'
                await focus(browser, 'close')
                await press(browser, 'Enter')
                assert not await browser.run(effect)
            elif name in ('time', 'control-pause', 'controls-title'):  # back to where it was
                await press(browser, 'ArrowRight' if name == 'time' else key)

    visit(browser_class, url, script)


def test_a_branch_is_pulled_by_keys_and_let_go(
    live: tuple[str, SimulatedWind, list[str]], browser_class: Any
) -> None:
    pull = 'treeSway.hands.drag.pull'

    async def script(browser: Browser) -> None:
        await browser.until("!document.getElementById('pull').hidden")
        await focus(browser, 'pull')
        await press(browser, ' ')
        await browser.until('treeSway.hands.drag?.isOn')
        azimuth = await browser.run('treeSway.scene.camera.azimuth')
        await focus(browser, 'view')
        for _ in range(8):
            await press(browser, 'ArrowRight')
        assert await browser.run(f'{pull}.segment') == await browser.run('treeSway.scene.followed')
        away = f'Math.hypot(...{pull}.to.map((x, c) => x - treeSway.scene.restPosition()[c]))'
        assert await browser.run(away) > 0.05 * await browser.run('treeSway.scene.height')
        await browser.until(f'{pull}.force > 0.01')
        await press(browser, 'Enter')
        assert not await browser.run(f'{pull}.isHeld')
        await browser.until("!document.getElementById('pull-save').hidden")
        await focus(browser, 'pull-save')
        assert await browser.run('treeSway.scene.camera.azimuth') == azimuth

    visit(browser_class, live[0], script)


def test_all_that_can_be_operated_has_a_name_in_the_accessibility_tree(
    live: tuple[str, SimulatedWind, list[str]], browser_class: Any
) -> None:
    roles = {'button', 'slider', 'combobox', 'image', 'link', 'DisclosureTriangle', 'option'}

    async def script(browser: Browser) -> None:
        await browser.until("!document.getElementById('pull').hidden")
        tree = await browser.call('Accessibility.getFullAXTree')
        named = [
            (node['role']['value'], node['name']['value'])
            for node in tree['nodes']
            if not node['ignored'] and node['role']['value'] in roles
        ]
        assert len(named) >= len(EFFECTS)
        assert [role for role, name in named if not name.strip()] == []
        assert len([name for role, name in named if role == 'button']) >= 13

    visit(browser_class, live[0], script)


_OF_FOCUS = """(() => {
  const e = document.activeElement, b = e.getBoundingClientRect();
  const middle = document.elementFromPoint(0.5 * (b.left + b.right), 0.5 * (b.top + b.bottom));
  return {
    name: e.id || e.localName,
    seen: Math.min(b.left, b.top, innerWidth - b.right, innerHeight - b.bottom) >= -1
      && (e.contains(middle) || Boolean(middle?.contains(e))),
  };
})()"""
_CARDS = """['head', 'traces', 'panel', 'tools'].map((id) => {
  const b = document.getElementById(id).getBoundingClientRect();
  return [b.left, b.top, b.right, b.bottom];
}).filter(([left, top, right, bottom]) => right > left && bottom > top)"""
_IS_CLEAR = """(() => {
  const [low, high] = [treeSway.scene._low, treeSway.scene._high];
  const [x, y] = low.map((each, c) => 0.5 * (each + high[c]));
  const cards = ['head', 'traces', 'panel', 'tools']
    .map((id) => document.getElementById(id).getBoundingClientRect());
  return [low[2], 0.5 * (low[2] + high[2]), high[2]].every((z) => {
    const at = treeSway.scene.camera.project([x, y, z]);
    const [left, top] = [at[0] * innerWidth, at[1] * innerHeight];
    const isIn = left >= 0 && left <= innerWidth && top >= 0 && top <= innerHeight;
    const isOn = (b) => b.left < left && left < b.right && b.top < top && top < b.bottom;
    return isIn && !cards.some(isOn);
  });
})()"""
"""Whether foot, middle and tip of the tree are in the picture, and behind no card."""


@pytest.mark.parametrize(
    ('width', 'height', 'zoom'), [(640, 360, 2.0), (320, 256, 4.0)], ids=['200 %', '400 %']
)
def test_a_window_that_is_zoomed_hides_neither_the_tree_nor_a_control(
    live: tuple[str, SimulatedWind, list[str]],
    browser_class: Any,
    width: int,
    height: int,
    zoom: float,
) -> None:
    """Of 1280 x 720 at 200 %, and of 1280 x 1024 at 400 %."""

    async def script(browser: Browser) -> None:
        await browser.call(
            'Emulation.setDeviceMetricsOverride',
            width=width, height=height, deviceScaleFactor=zoom, mobile=False,
        )  # fmt: skip
        await browser.call('Page.reload')  # a window that was opened so, as its panel is closed
        await browser.until(f'innerWidth === {width} && {LIVE}')
        await browser.until("!document.getElementById('pull').hidden")
        drawn = await browser.run('treeSway.scene._frame')
        await browser.until(f'treeSway.scene._frame > {drawn} + 2')
        # A text that comes late makes its card higher, and the tree makes room for it.
        await browser.run("document.getElementById('warnings').textContent = 'a warning'")
        await browser.until(_IS_CLEAR)
        cards = await browser.run(_CARDS)
        for i, one in enumerate(cards):
            for other in cards[:i]:
                apart = one[0] >= other[2] or other[0] >= one[2]
                assert apart or one[1] >= other[3] or other[1] >= one[3], (one, other)
        found = set()
        for is_open in ('false', 'true'):
            await browser.run(f"document.getElementById('panel').open = {is_open}")
            wanted = set(await browser.run(CONTROLS))
            found |= wanted
            reached = dict[str, dict[str, Any]]()
            for _ in range(40):
                await press(browser, 'Tab')
                end = asyncio.get_running_loop().time() + 2.0
                while not (at := await browser.run(_OF_FOCUS))['seen']:  # it scrolls there
                    if asyncio.get_running_loop().time() > end:
                        break
                reached.setdefault(at['name'], at)
            assert wanted <= set(reached)
            assert [each for name, each in reached.items() if name in wanted - {'view'}
                    and not each['seen']] == []  # fmt: skip
        away = {'shown', 'time'} if zoom > 2.0 else set()  # the lines have no room at 400 %
        assert set(EFFECTS) - away <= found
        assert await browser.run('document.documentElement.scrollWidth') <= width
        assert await browser.run('document.documentElement.scrollHeight') <= height

    visit(browser_class, live[0], script)
