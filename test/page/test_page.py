# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The page in a real browser: what is drawn, what hands do, what it says when the line is cut."""

from __future__ import annotations

import argparse
import asyncio
from collections.abc import Callable, Coroutine, Iterator
import io
import json
from pathlib import Path
import re
import shutil
import subprocess
import tarfile
from typing import Any

import numpy as np
import pytest

pytest.importorskip('aiohttp', reason='aiohttp is not installed')
Image = pytest.importorskip('PIL.Image', reason='Pillow is not installed')

from tree_sway_lab.browser import DEADLINE  # noqa: E402

from tree_sway.core.settings import Settings  # noqa: E402
from tree_sway.files.trees.source import open_scene  # noqa: E402
from tree_sway.page.commands import show  # noqa: E402
from tree_sway.page.page_settings import PageSettings  # noqa: E402
from tree_sway.page.server import PageServer  # noqa: E402
from tree_sway.page.session import Choices, Session  # noqa: E402
from tree_sway.simulation.wind_source import SimulatedWind  # noqa: E402
from tree_sway.stream.controls import Control, ControlPanel  # noqa: E402

STAND = Path(__file__).parents[2] / 'config' / 'stand.yaml'
Browser = Any
Script = Callable[[Browser], Coroutine[Any, Any, None]]
Visit = Callable[..., None]


class Live:
    """A tree in wind and the server of its page, which can be killed and started again."""

    def __init__(self) -> None:
        source = open_scene('goldcrest')
        simulator = source.simulator(Settings(), model=12)
        self.wind = SimulatedWind(9.0)
        self.session = Session(lambda _: simulator, Choices('goldcrest'), self.wind)
        controls = (
            Control('mean_speed', 'Wind', 9.0, 'Mean', 'm/s', 0.0, 40.0),
            Control('bearing_to', 'Blows to', 0.5 * np.pi, 'Blows to', 'rad', -6.3, 6.3),
            Control('tolerance', 'Tolerance', 0.005, 'Of auto', 'm', 1e-6, 10.0),
            Control('age', 'Age', 0.0, 'In years', minimum=0.0, maximum=150.0),
            Control('pause', 'Pause', False),
            Control('reset', 'Reset', None, is_action=True),
        )
        self.panel = ControlPanel(controls, self.session.apply)
        self.port = 0
        self.start()

    def start(self) -> None:
        self.server = PageServer(
            PageSettings(port=self.port), self.panel, self._status, self.session.written
        )
        self.server.start()
        self.port = self.server.port
        self.session.serve(self.server)

    def _status(self) -> dict[str, object]:
        return {**self.session.status(), 'facts': {'Beaufort': '5 <b>'}}


@pytest.fixture(scope='module')
def live() -> Iterator[Live]:
    """One for all tests, as setting a tree up takes a while."""
    made = Live()
    yield made
    made.session.stop()
    made.server.close()


@pytest.fixture
def visit(live: Live, browser_class: Any) -> Visit:
    """Open the page, wait until it is live, run a script, and see that nothing went wrong."""

    def visited(script: Script, **size: Any) -> None:
        async def whole() -> None:
            async with browser_class() as browser:
                await browser.open(live.server.url, **size)
                await browser.until("window.treeSway && treeSway.state === 'live'")
                await browser.until('treeSway.fps > 0')
                await script(browser)
                assert browser.console == []
                others = [url for url in browser.requests if not url.startswith(live.server.url)]
                assert [url for url in others if not url.startswith('data:')] == []

        asyncio.run(whole())

    return visited


def picture(data: bytes) -> Any:
    """Return a screenshot as (h, w, 3)."""
    return np.asarray(Image.open(io.BytesIO(data)).convert('RGB'), dtype=np.int16)


def test_the_tree_is_drawn_where_it_projects(visit: Visit) -> None:
    async def script(browser: Browser) -> None:
        await browser.run("document.getElementById('leaves').click()")
        await browser.run("document.getElementById('control-pause').click()")
        await browser.until("treeSway.state === 'paused'")
        await asyncio.sleep(0)
        await browser.until('treeSway.fps > 0')
        stem = await browser.run(
            'Array.from({length: 8}, (_, s) => treeSway.scene.camera.project('
            'treeSway.scene.position(s + 1)))'
        )
        image = picture(await browser.screenshot())
        high, wide, _ = image.shape
        for x, y in stem:
            row, column = round(y * high), round(x * wide)
            near = image[row - 1 : row + 2, column - 1 : column + 2].reshape(-1, 3)
            beside = image[row, column + 330]
            assert (np.abs(near - beside).sum(axis=1) > 60).any(), (x, y)
        await browser.run("document.getElementById('control-pause').click()")

    visit(script, scale=1.0)


def test_it_moves_in_wind_and_is_still_when_paused(visit: Visit) -> None:
    async def change(browser: Browser) -> float:
        before = picture(await browser.screenshot())[100:600, 380:900]
        drawn = await browser.run('treeSway.scene._frame')
        await browser.until(f'treeSway.scene._frame > {drawn} + 8')
        after = picture(await browser.screenshot())[100:600, 380:900]
        return float((np.abs(after - before).sum(axis=2) > 30).mean())

    async def script(browser: Browser) -> None:
        assert await change(browser) > 0.005
        await browser.run("document.getElementById('control-pause').click()")
        await browser.until("treeSway.state === 'paused'")
        drawn = await browser.run('treeSway.scene._frame')
        await browser.until(f'treeSway.scene._frame > {drawn} + 12')
        assert await change(browser) == 0.0
        await browser.run("document.getElementById('control-pause').click()")
        await browser.until("treeSway.state === 'live'")

    visit(script, scale=1.0)


def test_the_slider_moves_the_wind(live: Live, visit: Visit) -> None:
    async def said(speed: float) -> None:
        while live.wind.values['mean_speed'] != speed:
            await asyncio.sleep(0.02)

    async def script(browser: Browser) -> None:
        await browser.run(
            "{const s = document.getElementById('control-mean_speed'); s.value = 3;"
            " s.dispatchEvent(new Event('input'));}"
        )
        # The page may not have had any wind yet: what is below 3.6 m/s then is none.
        await asyncio.wait_for(said(3.0), DEADLINE)
        await browser.until('Math.hypot(...treeSway.playout.wind) < 3.6')  # no lull of 9 m/s
        await browser.run(
            "{const s = document.getElementById('control-mean_speed'); s.value = 9;"
            " s.dispatchEvent(new Event('input'));}"
        )
        await browser.until('Math.hypot(...treeSway.playout.wind) > 5.5')

    visit(script)


def test_the_head_names_the_wind_the_line_and_the_error(live: Live, visit: Visit) -> None:
    text = "document.getElementById('%s').textContent"

    async def script(browser: Browser) -> None:
        await browser.until(f"{text % 'source'} === 'Simulated wind'")
        await browser.until(f"{text % 'state-text'} === 'Connected'")
        *words, value, unit = (await browser.run(text % 'error')).split()
        assert (words, unit) == (['up', 'to'], 'mm')
        basis = live.session._scene.kinds[0].basis
        assert float(value) == pytest.approx(1000.0 * basis.error, rel=0.06)
        live.wind.source = {'kind': 'recorded', 'name': 'canopy'}
        await browser.until(f"{text % 'source'} === 'Recorded: canopy'")
        live.wind.source = {'kind': 'live', 'name': '/wind', 'rate': 20.2}  # type: ignore[dict-item]
        await browser.until(f"{text % 'source'} === 'Live: /wind, 20 Hz'")
        await browser.run(
            "{const s = document.getElementById('language'); s.value = 'de';"
            " s.dispatchEvent(new Event('change'));}"
        )
        live.wind.source = {'kind': 'simulated'}
        await browser.until(f"{text % 'source'} === 'Simulierter Wind'")

    visit(script)


def test_the_facts_of_other_packages_are_listed(visit: Visit) -> None:
    async def look(browser: Browser) -> None:
        rows = '[...document.querySelectorAll("#facts .added")]'
        await browser.until(f"{rows}.map((each) => each.textContent).join() === 'Beaufort5 <b>'")

    visit(look)


def test_the_wind_comes_from_one_of_360_degrees(live: Live, visit: Visit) -> None:
    slider = "document.getElementById('control-bearing_to')"

    async def script(browser: Browser) -> None:
        label = f'{slider}.labels[0].innerText.split(/\\s*\\n\\s*/).join(" ")'
        assert await browser.run(f'[{slider}.min, {slider}.max, {slider}.value]') == [
            '0', '360', '270',
        ]  # fmt: skip
        assert await browser.run(label) == 'Wind from W (270°)'
        assert 'comes from' in await browser.run(f'{slider}.title')
        for degrees, point in (
            (90, 'E (90°)'),
            (0, 'N (0°)'),
            (360, 'N (0°)'),
            (225, 'SW (225°)'),
        ):
            await browser.run(
                f'{{const s = {slider}; s.value = {degrees};'
                " s.dispatchEvent(new Event('input'));}"
            )
            assert await browser.run(f"{slider}.getAttribute('aria-valuetext')") == point
            x, y = -np.sin(np.radians(degrees)), -np.cos(np.radians(degrees))
            await browser.until(
                f'((w) => (w[0] * {x} + w[1] * {y}) / Math.hypot(...w) > 0.8)'
                '(treeSway.playout.wind)'
            )
        assert await browser.run(
            "document.getElementById('control-tolerance').closest('.field').hidden"
        )
        await browser.run(
            f"{{const s = {slider}; s.value = 270; s.dispatchEvent(new Event('input'));}}"
        )
        await browser.until('treeSway.playout.wind[0] > 4')

    visit(script)


def test_a_token_leaves_the_address_and_links_are_to_look_only(
    live: Live, browser_class: Any
) -> None:
    settings = PageSettings(port=0, token='long-enough-token')
    with PageServer(settings, live.panel, live.session.status, live.session.written) as server:

        async def whole() -> None:
            async with browser_class() as browser:
                is_live = "window.treeSway && treeSway.state === 'live' && treeSway.fps > 0"
                live.session.serve(server)
                await browser.open(server.url)
                await browser.until("document.getElementById('refused')")
                await browser.open(f'{server.url}?token=long-enough-token')
                await browser.until(is_live)
                assert await browser.run('location.href') == server.url
                assert not await browser.run("document.getElementById('panel').hidden")
                await browser.run("document.getElementById('link').click()")
                await browser.until("!document.getElementById('toast').hidden")
                link = await browser.run("document.getElementById('toast').innerText")
                assert f'?token={server.viewers_token}#view=' in link
                assert 'to look only' in link
                assert 'token' not in await browser.run('location.href')
                await browser.open(server.url)  # again: the cookie has it
                await browser.until(is_live)
                assert not await browser.run("document.getElementById('panel').hidden")
                await browser.open(f'{server.url}?token={server.viewers_token}')
                await browser.until(is_live)
                assert await browser.run("document.getElementById('panel').hidden")
                own = {'headers': {'X-Requested-With': 'x'}}
                for options, status in ((own, 200), ({}, 403)):
                    asked = f"fetch('tree.glb', {json.dumps(options)}).then((a) => a.status)"
                    assert await browser.run(asked) == status

        try:
            asyncio.run(whole())
        finally:
            live.session.serve(live.server)


def test_a_lost_server_is_reported_and_found_again(live: Live, visit: Visit) -> None:
    async def script(browser: Browser) -> None:
        live.server.close()
        await browser.until("treeSway.state === 'lost'")
        await browser.until("!document.getElementById('notice').hidden")
        notice = await browser.run("document.getElementById('notice').innerText")
        assert 'Connection lost' in notice
        # A change would go nowhere, and a file cannot be fetched.
        assert await browser.run("document.getElementById('controls').inert")
        await browser.run("document.getElementById('glb').click()")
        toast = "document.getElementById('toast').textContent"
        await browser.until(f"{toast} === 'Connection lost'")
        live.start()
        await browser.until("treeSway.state === 'live'")
        assert await browser.run("document.getElementById('notice').hidden")
        assert not await browser.run("document.getElementById('controls').inert")

    visit(script)


def test_a_slider_that_is_set_back_before_it_is_sent_is_sent(live: Live, visit: Visit) -> None:
    async def script(browser: Browser) -> None:
        await browser.run(
            """{
              const slider = document.getElementById('control-mean_speed');
              slider.value = 4;
              slider.dispatchEvent(new Event('input'));
              // Values of the server come while another slider is moved.
              document.getElementById('control-age').dispatchEvent(new Event('input'));
              slider.value = 9;
            }"""
        )
        await browser.until("document.getElementById('control-mean_speed').value === '4'")
        assert live.wind.values['mean_speed'] == 4.0

    visit(script)


def test_a_link_that_was_copied_fits_its_card_and_is_no_problem(visit: Visit) -> None:
    async def script(browser: Browser) -> None:
        await browser.run("document.getElementById('link').click()")
        await browser.until("document.getElementById('toast').textContent.includes('view=')")
        toast = "document.getElementById('toast')"
        assert await browser.run(f'{toast}.scrollWidth <= {toast}.clientWidth')
        assert not await browser.run(f"{toast}.classList.contains('problem')")

    visit(script)


def test_everything_has_a_name_and_keys_turn_the_tree(visit: Visit) -> None:
    async def script(browser: Browser) -> None:
        nameless = await browser.run(
            "[...document.querySelectorAll('button, input, select, canvas')].filter((e) =>"
            ' !(e.ariaLabel || e.innerText || e.labels?.length)).map((e) => e.outerHTML)'
        )
        assert nameless == []
        before = await browser.run('treeSway.scene.camera.azimuth')
        await browser.run("document.getElementById('view').focus()")
        key = {'key': 'ArrowRight', 'code': 'ArrowRight', 'windowsVirtualKeyCode': 39}
        await browser.call('Input.dispatchKeyEvent', type='keyDown', **key)
        assert await browser.run('treeSway.scene.camera.azimuth') != before
        for kind, x in (('mousePressed', 500), ('mouseMoved', 620), ('mouseReleased', 620)):
            await browser.call(
                'Input.dispatchMouseEvent', type=kind, x=x, y=300, button='left', buttons=1,
                clickCount=1,
            )  # fmt: skip
        assert abs(await browser.run('treeSway.scene.camera.azimuth') - before) > 0.3
        await browser.call(
            'Input.dispatchMouseEvent', type='mouseWheel', x=600, y=300, deltaX=0, deltaY=-300
        )
        far = await browser.run('treeSway.scene.camera.distance')
        await browser.run("document.getElementById('home').click()")
        assert await browser.run('treeSway.scene.camera.distance') > far

    visit(script)


def test_the_button_of_the_leaves_says_what_is(live: Live, visit: Visit) -> None:
    async def script(browser: Browser) -> None:
        pressed = "document.getElementById('leaves').getAttribute('aria-pressed')"
        assert await browser.run('treeSway.scene.hasLeaves')
        assert await browser.run(pressed) == 'true'
        await browser.run("document.getElementById('leaves').click()")
        assert await browser.run(pressed) == 'false'
        # The same tree without leaves.
        await browser.run(
            '{const d = treeSway.scene.description; treeSway.scene.describe({...d, kinds: '
            ' d.kinds.map((k) => ({...k, arrays: {...k.arrays, leaf_segment: undefined}}))});}'
            "document.getElementById('leaves').click()"
        )
        assert await browser.run("document.getElementById('leaves').disabled")
        assert await browser.run(pressed) == 'false'

    visit(script)


def test_a_branch_is_picked_and_read(visit: Visit) -> None:
    async def script(browser: Browser) -> None:
        name = "document.getElementById('branch').textContent"
        assert await browser.run(name) == 'highest branch'
        x, y = await browser.run(
            'treeSway.scene.camera.project(treeSway.scene.position(4)).map((each, i) =>'
            ' each * [innerWidth, innerHeight][i])'
        )
        for kind in ('mousePressed', 'mouseReleased'):
            await browser.call(
                'Input.dispatchMouseEvent', type=kind, x=x, y=y, button='left', clickCount=1
            )
        await browser.until('treeSway.scene.picked >= 0')
        picked = await browser.run('treeSway.scene.picked')
        names = 'treeSway.scene.watched.kind.branch_names'
        assert await browser.run(name) == await browser.run(f'{names}[{picked}]')
        for key, then in ((']', picked + 1), ('[', picked)):
            await browser.run("document.getElementById('view').focus()")
            await browser.call('Input.dispatchKeyEvent', type='keyDown', key=key, text=key)
            assert await browser.run('treeSway.scene.picked') == then
        await browser.run(
            "{const s = document.getElementById('shown'); s.value = 'strain';"
            " s.dispatchEvent(new Event('change'));}"
        )
        await browser.until('treeSway.traces.tip.statistics?.greatest > 1e-6')
        assert await browser.run('treeSway.traces.tip.statistics.greatest') < 0.05

    visit(script)


def test_strain_and_moment_are_those_of_the_wood(visit: Visit) -> None:
    """A moment of E I over the radius times the strain, in newton metres."""

    async def script(browser: Browser) -> None:
        await browser.until('treeSway.scene.load().strain > 1e-6')
        strain, moment, radius, modulus = await browser.run(
            '(({strain, moment}, {arrays, modulus}) => [strain, moment, arrays.segment_radius[2],'
            ' modulus])(treeSway.scene.load(), treeSway.scene.watched.kind)'
        )
        assert moment == pytest.approx(0.25 * np.pi * modulus * radius**3 * strain, rel=1e-5)
        await browser.run(
            "{const s = document.getElementById('shown'); s.value = 'moment';"
            " s.dispatchEvent(new Event('change'));}"
        )
        await browser.until("document.getElementById('tip-now').textContent.endsWith('N m')")

    visit(script)


def test_the_last_minute_is_looked_back_at(visit: Visit) -> None:
    async def script(browser: Browser) -> None:
        slide = (
            "{const s = document.getElementById('time'); s.value = %s;"
            " s.dispatchEvent(new Event('input'));}"
        )
        # A busy machine loses frames, and nothing is shown between states that are far apart.
        await browser.until(
            '((f) => f.at(-1).stamp - f[0].stamp > 1200 && f.every((each, i) =>'
            ' !i || each.stamp - f[i - 1].stamp < 300 || each.stamp < f.at(-1).stamp - 1200)'
            ')(treeSway.playout._frames)'
        )
        await browser.run(slide % -1)
        assert await browser.run('treeSway.state') == 'paused'
        assert '1.0 s ago' in await browser.run("document.getElementById('state').textContent")
        at = 'Array.from(treeSway.stream.sample())'
        then, first = await browser.run(at), await browser.run('treeSway.playout.received')
        await browser.until(f'treeSway.playout.received > {first} + 5')
        assert await browser.run(at) == then
        await browser.run(slide % -0.5)
        assert await browser.run(at) != then
        await browser.run(slide % 0)
        await browser.until("treeSway.state === 'live'")

    visit(script)


def test_clip_and_tree_are_taken_along(visit: Visit) -> None:
    async def script(browser: Browser) -> None:
        await browser.run(
            'window.taken = []; let size; const make = URL.createObjectURL;'
            'URL.createObjectURL = (blob) => { size = blob.size; return make.call(URL, blob); };'
            'HTMLAnchorElement.prototype.click ='
            ' function () { taken.push([this.download, size]); }'
        )
        await browser.run("document.getElementById('clip').click()")
        drawn = await browser.run('treeSway.scene._frame')
        await browser.until(f'treeSway.scene._frame > {drawn} + 15')
        for name in ('clip', 'glb', 'html', 'picture'):
            await browser.run(f"document.getElementById('{name}').click()")
        await browser.until('taken.length === 4')
        taken = dict(await browser.run('taken'))
        assert {Path(name).suffix for name in taken} >= {'.glb', '.html', '.png'}
        assert {Path(name).stem for name in taken} == {'goldcrest'}
        assert min(taken.values()) > 1000

    visit(script)


def test_a_link_keeps_camera_and_view(live: Live, visit: Visit) -> None:
    async def script(browser: Browser) -> None:
        await browser.run('treeSway.scene.camera.orbit(100, 40)')
        await browser.run("document.getElementById('season').click()")
        view = '[treeSway.scene.camera.azimuth, treeSway.scene.camera.elevation]'
        before = await browser.run(view)
        await browser.run("document.getElementById('link').click()")
        link = await browser.run('location.hash')
        assert 'view=' in link
        await browser.open('about:blank')
        await browser.open(f'{live.server.url}{link}')
        await browser.until("window.treeSway && treeSway.state === 'live'")
        np.testing.assert_allclose(await browser.run(view), before, rtol=1e-3)
        assert await browser.run('treeSway.scene.isAutumn')

    visit(script)


def test_a_link_asks_for_its_tree_and_says_what_it_cannot_have(live: Live, visit: Visit) -> None:
    usual = live.session.choices

    async def script(browser: Browser) -> None:
        await browser.run("document.getElementById('link').click()")
        assert 'age=0' in await browser.run('location.hash')
        await browser.open('about:blank')
        await browser.open(f'{live.server.url}#age=12&tree=oak&height=tall')
        await browser.until("window.treeSway && treeSway.state === 'live'")
        await browser.until("document.getElementById('control-age').value === '12'")
        told = "document.getElementById('toast').textContent"
        await browser.until(f"{told}.includes('oak') && {told}.includes('tall')")
        assert '12' not in await browser.run(told)

    try:
        visit(script)
    finally:
        live.session.choices = usual


def test_the_slider_of_age_says_whose_stem_a_tree_has(live: Live, visit: Visit) -> None:
    usual = live.session.choices
    field = "document.getElementById('control-age').closest('.field')"

    async def script(browser: Browser) -> None:
        live.session.choices = Choices('oak')
        whose = 'Stem of Quercus rubra (McPherson 2016)'
        await browser.until(f"!{field}.hidden && {field}.textContent.includes('{whose}')")
        described = "document.getElementById('control-age').ariaDescribedByElements"
        assert await browser.run(f'{described}[0].textContent') == whose
        live.session.choices = Choices('willow')
        await browser.until(f'{field}.hidden')

    try:
        visit(script)
    finally:
        live.session.choices = usual


def test_it_speaks_languages(visit: Visit) -> None:
    async def script(browser: Browser) -> None:
        for language, title in (('de', 'Steuerung'), ('fr', 'Réglages'), ('ja', '操作')):
            await browser.run(
                f"{{const s = document.getElementById('language'); s.value = '{language}';"
                " s.dispatchEvent(new Event('change'));}"
            )
            found = await browser.run("document.querySelector('summary').textContent")
            assert found == title
            words = "import('/static/words.js').then((m) => "
            assert await browser.run(words + "m.wordOr('model', '') !== '')"), language
            short = (
                words + "[...document.querySelectorAll('[data-word]')]"
                '.filter((e) => !m.wordOr(e.dataset.word, "")).map((e) => e.dataset.word))'
            )
            assert await browser.run(short) == [], language

    visit(script)


@pytest.mark.parametrize(
    ('source', 'text'),
    [
        ({'name': 'Berlin, open-meteo', 'state': 'live', 'speed': 6.4, 'wind': [6.4, 0.0],
          'age': 180.0, 'is_mean': True},
         'Live: Berlin, open-meteo, 6.4 m/s from W (270°), 3 min ago, gusts simulated about its '
         'mean'),
        ({'name': 'Mast', 'state': 'live', 'speed': 6.44, 'wind': [0.0, -6.4], 'age': 0.1},
         'Live: Mast, 6.4 m/s from N (0°)'),
        ({'name': 'cup', 'state': 'stale', 'speed': 5.0, 'wind': [5.0, 0.0], 'age': 40.0,
          'lacks_direction': True},
         'Live: cup, 5.0 m/s from W (270°), 40 s ago, direction assumed, too old'),
        ({'name': 'EDDB', 'state': 'live', 'speed': 0.0, 'wind': [0.0, 0.0], 'age': 7300.0},
         'Live: EDDB, 0.0 m/s, 2 h ago'),
        ({'name': 'udp://:1', 'state': 'waiting'}, 'Live: udp://:1, no wind yet'),
        ({'name': 'udp://:1', 'state': 'unknown'}, 'Live: udp://:1, messages not understood'),
        ({'name': 'wind', 'rate': 19.9}, 'Live: wind, 20 Hz'),
    ],
)  # fmt: skip
def test_the_head_names_the_live_wind_its_speed_and_its_age(
    visit: Visit, source: dict[str, Any], text: str
) -> None:
    async def script(browser: Browser) -> None:
        described = json.dumps({'kind': 'live', **source})
        said = f"import('/static/words.js').then((m) => m.windSource({described}))"
        assert await browser.run(said) == text

    visit(script)


def test_trees_are_coloured_by_a_storm(live: Live, browser_class: Any) -> None:
    """Goldcrest's band is 20 to 30 m/s: a storm is below, within or above it."""
    server = PageServer(
        PageSettings(port=0),
        ControlPanel(),
        live.session.status,
        critical_winds={'goldcrest': (20, 30)},
    )

    async def look() -> None:
        async with browser_class() as browser:
            await browser.open(server.url)
            await browser.until("window.treeSway && treeSway.state === 'live'")
            await browser.until("!document.getElementById('risk').hidden")
            counts, pictures = {}, {}
            for storm in (10, 25, 40):
                await browser.run(
                    f'document.getElementById("storm").value = {storm};'
                    'document.getElementById("storm").dispatchEvent(new Event("input")); 1'
                )
                counts[storm] = await browser.run(
                    '[...document.querySelectorAll("#risk-counts li:not([hidden])")]'
                    '.map((each) => parseInt(each.textContent))'
                )
                await browser.run('new Promise((done) => setTimeout(() => done(1), 500))')
                pictures[storm] = picture(await browser.screenshot())
            assert counts == {10: [1, 0, 0], 25: [0, 1, 0], 40: [0, 0, 1]}
            painted = np.abs(pictures[40] - pictures[10]).max(axis=2) > 60
            assert painted.mean() > 0.01
            colors = {storm: each[painted].mean(axis=0) for storm, each in pictures.items()}
            assert np.argmax(colors[10]) == 2
            assert colors[25][0] > colors[25][1] > 1.5 * colors[25][2]
            assert colors[40][0] > 1.5 * colors[40][1]
            assert 'afe' not in await browser.run('document.getElementById("risk").innerText')
            assert browser.console == []

    with server:
        live.session.serve(server)
        try:
            asyncio.run(look())
        finally:
            live.session.serve(live.server)


@pytest.mark.parametrize(
    ('said', 'text'),
    [
        (None, ''),
        ([['sensor_elsewhere']], 'Sensors: not on this tree'),
        ([['sensor_followed', 'mast', '99', '0.25; in g'], ['limb: silent'], [5], []],
         'mast: followed, 99 Hz, residual 0.25; in g\nlimb: silent\n5\nundefined'),
    ],
)  # fmt: skip
def test_the_head_says_what_the_server_tells_of_sensors(
    visit: Visit, said: Any, text: str
) -> None:
    async def script(browser: Browser) -> None:
        told = 'undefined' if said is None else json.dumps(said)
        shown = f"import('/static/words.js').then((m) => m.sentences({told}))"
        assert await browser.run(shown) == text

    visit(script)


def test_the_band_is_shaded_about_the_line(visit: Visit) -> None:
    async def script(browser: Browser) -> None:
        shade = "document.querySelector('#tip-trace .band').getAttribute('d')"
        drawn = (
            "import('/static/trace.js').then(({Trace}) => {"
            " const made = new Trace(document.getElementById('tip-trace'), 'motion');"
            f' made.add(0, 0.1); made.draw(); const without = {shade};'
            ' [1, 2].forEach((time) => made.add(time, 0.1, [-0.2, 0.05])); made.draw();'
            f' return [without, {shade}]; }})'
        )
        without, points = await browser.run(drawn)
        assert without == ''
        numbers = re.findall(r'[\d.e-]+', points)
        corners = np.array([float(each) for each in numbers]).reshape(-1, 2)
        # Of 0.2 m: up to 0.15 m where the band is known, and no lower than at rest.
        known = corners[corners[:, 0] > 18.5]
        np.testing.assert_allclose(np.unique(known[:, 1]), [0.25, 1.0])

    visit(script)


def test_a_trace_has_gaps_where_nothing_was_measured(visit: Visit) -> None:
    async def script(browser: Browser) -> None:
        line = "document.querySelector('#wind-trace .line').getAttribute('d')"
        drawn = (
            "import('/static/trace.js').then(({Trace}) => {"
            " const made = new Trace(document.getElementById('wind-trace'), 'wind');"
            ' const none = made.statistics;'
            ' [0, 0.5, 15.5, 16].forEach((time) => made.add(time, 5));'
            f' made.add(16.5, NaN); made.add(17, 7); made.draw();'
            f' return [none, {line}.split("M").length - 1, made.statistics]; }})'
        )
        none, runs, statistics = await browser.run(drawn)
        assert none is None
        assert runs == 3
        assert statistics == {'mean': 5.4, 'greatest': 7}

    visit(script)


def test_keys_work_after_a_click_on_a_button(visit: Visit) -> None:
    async def script(browser: Browser) -> None:
        await browser.run("document.getElementById('theme').focus()")
        for key, value in (('l', 'scene.leavesShown'), ('ArrowRight', 'scene.camera.azimuth')):
            before = await browser.run(f'treeSway.{value}')
            await browser.call('Input.dispatchKeyEvent', type='keyDown', key=key)
            assert await browser.run(f'treeSway.{value}') != before

    visit(script)


def test_a_control_of_text_takes_what_is_typed(visit: Visit) -> None:
    async def script(browser: Browser) -> None:
        sent = await browser.run(
            "import('/static/panel.js').then(({Panel}) => {"
            " const form = document.createElement('form'), sent = [];"
            ' const panel = new Panel(form, (...change) => sent.push(change));'
            " panel.build([{name: 'sensor_at', label: '', value: '3.2', choices: []}]);"
            " const input = form.querySelector('input'); sent.push(input.value);"
            " input.value = 'b12:0.5'; input.dispatchEvent(new Event('change')); return sent; })"
        )
        assert sent == ['3.2', ['sensor_at', 'b12:0.5']]

    visit(script)


def test_text_contrasts_with_its_ground(visit: Visit) -> None:
    """By 4.5 to 1, as WCAG 2 asks."""

    async def script(browser: Browser) -> None:
        ratios = await browser.run(
            "['light', 'dark'].flatMap((theme) => {"
            ' document.documentElement.dataset.theme = theme;'
            " const parse = (name) => { const e = document.createElement('i'); e.style.color ="
            ' `var(${name})`; document.body.append(e); const c = getComputedStyle(e).color'
            '.match(/[0-9.]+/g).map(Number); e.remove(); return c; };'
            ' const bright = (c) => c.slice(0, 3).map((v) => v / 255).map((v) =>'
            ' v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4)'
            '.reduce((s, v, i) => s + v * [0.2126, 0.7152, 0.0722][i], 0);'
            " const back = bright(parse('--card'));"
            " return ['--text', '--soft', '--blue', '--green', '--amber', '--red'].map((n) => {"
            ' const [a, b] = [bright(parse(n)), back].sort((x, y) => y - x);'
            ' return (a + 0.05) / (b + 0.05); }); })'
        )
        assert min(ratios) > 4.5, ratios

    visit(script)


def test_without_webassembly_it_says_which_browser_to_take(live: Live, browser_class: Any) -> None:
    async def whole() -> None:
        async with browser_class() as browser:
            lacking = 'WebAssembly.validate = () => false'
            await browser.call('Page.addScriptToEvaluateOnNewDocument', source=lacking)
            await browser.open(live.server.url)
            await browser.until("document.getElementById('notice')?.hidden === false")
            text = await browser.run("document.getElementById('notice').innerText")
            assert 'no WebAssembly with SIMD' in text and 'Chrome 91' in text  # noqa: PT018

    asyncio.run(whole())


def test_without_webgl_it_says_why_and_what_to_do(live: Live, browser_class: Any) -> None:
    async def whole() -> None:
        async with browser_class() as browser:
            await browser.call(
                'Page.addScriptToEvaluateOnNewDocument',
                source='HTMLCanvasElement.prototype.getContext = function () { return null; };',
            )
            await browser.open(live.server.url)
            await browser.until("document.getElementById('notice')?.hidden === false")
            text = await browser.run("document.getElementById('notice').innerText")
            assert 'WebGL 2' in text and 'hardware acceleration' in text  # noqa: PT018

    asyncio.run(whole())


@pytest.mark.long
def test_a_stand_of_a_thousand_trees_is_drawn_and_moves(browser_class: Any) -> None:
    """On levels that grow where the camera comes near, in less than 1 GB."""
    parser = argparse.ArgumentParser()
    show.add_arguments(parser)
    arguments = parser.parse_args([str(STAND)])
    choices = Choices(STAND.name)
    session = Session(lambda each: show.build_scene(each, arguments), choices, SimulatedWind(9.0))

    async def whole(url: str) -> None:
        async with browser_class() as browser:
            await browser.open(url, scale=1.0)
            await browser.until("window.treeSway && treeSway.state === 'live' && treeSway.fps > 0")
            assert await browser.run('treeSway.scene.detail.trees.length') == 1000
            assert await browser.run('treeSway.scene.description.nSegments') > 1_000_000
            assert await browser.run('treeSway.scene.detail.segments') < 60_000
            assert (
                await browser.run("document.getElementById('trees').textContent") == '1\u202f000'
            )
            assert await browser.run("document.getElementById('glb').disabled")
            # It is seen from its edge; from afar no tree is out of sight.
            assert await browser.run('Math.max(...treeSway.scene.detail.level) > 0')
            await browser.run('treeSway.scene.camera.zoom(4)')
            await browser.until('treeSway.scene.detail.level.every((each) => each >= 0)')
            await browser.run('treeSway.scene.camera.home()')
            await browser.until('treeSway.scene.detail.level.some((each) => each < 0)')
            before = await browser.run('treeSway.scene.position()')
            shot = picture(await browser.screenshot())
            await browser.until(
                'Math.hypot(...treeSway.scene.position().map((each, c) => each - '
                f'{json.dumps(before)}[c])) > 0.02'
            )
            dark = (shot[100:].sum(axis=2) < 230).mean()  # of trees before a light ground
            assert dark > 0.06
            moved = np.abs(picture(await browser.screenshot()) - shot).sum(axis=2) > 30
            assert moved[220:600, 340:1000].mean() > 0.002
            await browser.run('treeSway.scene.camera.zoom(0.1)')
            await browser.until('treeSway.scene.detail.level.some((each) => each < 0)')
            await browser.until('Math.max(...treeSway.scene.detail.level) > 2')
            heap = await browser.run('performance.memory.usedJSHeapSize')
            assert heap < 1e9
            assert browser.console == []

    with PageServer(PageSettings(port=0), None, session.status) as server:
        session.serve(server)
        try:
            asyncio.run(whole(server.url))
        finally:
            session.stop()
    assert session.failure is None


_BOXES = """['head', 'traces', 'panel', 'tools'].map((id) => {
  const b = document.getElementById(id).getBoundingClientRect();
  return [b.left, b.top, b.right, b.bottom];
}).filter(([left, , right]) => right > left)"""
_CROWN = """[treeSway.scene._low, treeSway.scene._high].map((p) => {
  const [x, y] = treeSway.scene.camera.project(p);
  return [x * innerWidth, y * innerHeight];
})"""


@pytest.mark.parametrize('is_open', [False, True])
@pytest.mark.parametrize('size', [(390, 844), (844, 390), (768, 1024)])
def test_it_fits_a_phone(visit: Visit, size: tuple[int, int], is_open: bool) -> None:
    width, height = size

    async def script(browser: Browser) -> None:
        await browser.run(f"document.getElementById('panel').open = {str(is_open).lower()}")
        drawn = await browser.run('treeSway.scene._frame')
        await browser.until(f'treeSway.scene._frame > {drawn} + 2')
        assert await browser.run('document.documentElement.scrollWidth') == width
        boxes = await browser.run(_BOXES)
        assert len(boxes) >= 2
        for left, top, right, bottom in boxes:
            assert left >= 0 and top >= 0 and right <= width and bottom <= height  # noqa: PT018
        for i, one in enumerate(boxes):
            for other in boxes[:i]:
                apart = [one[0] >= other[2], other[0] >= one[2]]
                assert any([*apart, one[1] >= other[3], other[1] >= one[3]]), (one, other)
        # The tree is between the cards.
        (x0, y0), (x1, y1) = await browser.run(_CROWN)
        x, y = 0.5 * (x0 + x1), 0.5 * (y0 + y1)
        assert all(not (b[0] < x < b[2] and b[1] < y < b[3]) for b in boxes)
        assert all(not (b[0] < x1 < b[2] and b[1] < y1 < b[3]) for b in boxes), (x1, y1, boxes)

    visit(script, width=width, height=height, scale=1.0)


_SIZES = [(320, 256), (320, 568), (559, 481), (640, 360), (701, 561), (800, 600), (3840, 2160)]
"""Sizes of windows in CSS pixels, from 400 % zoom to 4K."""


def test_no_card_covers_another(visit: Visit) -> None:
    async def script(browser: Browser) -> None:
        for width, height in _SIZES:
            await browser.call(
                'Emulation.setDeviceMetricsOverride',
                width=width, height=height, deviceScaleFactor=0.2, mobile=False,
            )  # fmt: skip
            for is_open in (False, True):
                await browser.run(
                    f"document.getElementById('panel').open = {str(is_open).lower()}"
                )
                boxes = await browser.run(_BOXES)
                for i, (left, top, right, bottom) in enumerate(boxes):
                    assert 0 <= left < right <= width, (width, height, boxes)
                    assert 0 <= top < bottom <= height, (width, height, boxes)
                    for other in boxes[:i]:
                        is_apart = (
                            left >= other[2] or other[0] >= right
                            or top >= other[3] or other[1] >= bottom
                        )  # fmt: skip
                        assert is_apart, (width, height, is_open, boxes)

    visit(script)


@pytest.fixture(scope='module')
def axe(tmp_path_factory: pytest.TempPathFactory) -> str:
    """Source of the checker of accessible pages, from npm's store if it is there."""
    npm, folder = shutil.which('npm'), tmp_path_factory.mktemp('axe')
    if npm is None:
        pytest.skip('npm is not installed here')
    command = [npm, 'pack', '--silent', 'axe-core@4']
    done = subprocess.run(command, cwd=folder, capture_output=True, check=False, timeout=180)
    if done.returncode:
        pytest.skip('npm cannot bring axe here')
    (packed,) = folder.glob('*.tgz')
    with tarfile.open(packed) as archive:
        source = archive.extractfile('package/axe.min.js')
        assert source is not None
        return source.read().decode()


_STATES = {
    'as it opens': '0',
    'sheet': "document.getElementById('panel').open = true",
    'camera': """for (const id of ['camera', 'own-camera', 'camera-known']) {
      Object.assign(document.getElementById(id), { hidden: false, open: true });
    }""",
    'sensors and a warning': """treeSway.connection.listeners.onMessage({ status: {
      motion: { said: [['sensors', '3 of 4']], band: [-1, 1] }, warnings: ['a warning'],
    } })""",
    'refused': """treeSway.connection.listeners.onMessage(
      { refused: { name: 'x', reason: 'a reason' } })""",
    'storm': """treeSway.risk.take(
      { [treeSway.connection.description.trees[0].name]: [20, 30] })""",
    'help': "document.getElementById('help').click()",
    'lost': "document.getElementById('close').click(); treeSway.connection._lose()",
}
"""What brings the page into a state, one after the other."""


@pytest.mark.parametrize('dark', [False, True])
def test_no_rule_of_axe_fails(visit: Visit, axe: str, dark: bool) -> None:
    async def script(browser: Browser) -> None:
        await browser.run(f'{axe}; 0')
        for state, action in _STATES.items():
            await browser.run(f'{action}; 0')
            broken = await browser.run(
                'axe.run(document).then(({ violations }) => violations.map('
                '({ id, nodes }) => [id, ...nodes.map(({ html }) => html.slice(0, 200))]))'
            )
            assert broken == [], state

    visit(script, dark=dark)


@pytest.mark.parametrize('dark', [False, True])
def test_a_phone_follows_the_colour_scheme(visit: Visit, dark: bool) -> None:
    async def script(browser: Browser) -> None:
        back = picture(await browser.screenshot())[200, 5].mean()
        assert (back < 80) == dark

    visit(script, width=390, height=844, dark=dark, scale=1.0)
