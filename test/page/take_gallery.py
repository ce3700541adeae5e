# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Take the pictures of doc/gallery.md from the page, in a headless Chromium.

    python test/page/take_gallery.py doc/pictures/gallery --walnut walnut.mtg

Trees that are no file are grown. Pictures in full quality are drawn as with a graphics unit, and
have nothing but the tree unless they show the page itself. A film is taken along the page's time
line, so that its pictures are as far apart as they are shown.

"""

from __future__ import annotations

import argparse
import asyncio
from dataclasses import dataclass
import io
from pathlib import Path
import sys
import tempfile

from PIL import Image
from tree_sway_lab.browser import Browser

from tree_sway.commands import cli
from tree_sway.page.commands import show
from tree_sway.page.commands.page_controls import page_controls
from tree_sway.page.page_settings import PageSettings
from tree_sway.page.server import PageServer
from tree_sway.page.session import Choices, Session
from tree_sway.simulation.wind_source import SimulatedWind
from tree_sway.stream.controls import ControlPanel

STAND = Path(__file__).parents[2] / 'config' / 'stand.yaml'
GROWN = {
    'oak': '--height 18 --diameter 1.1 --seed 5',
    'birch': '--height 16',
    'spruce': '--height 20 --diameter 0.55 --seed 1',
    'fir': '--height 20 --diameter 0.6 --seed 3',
    'pine': '--height 18 --diameter 0.5 --seed 1',
    'lime': '--height 18 --diameter 0.75 --seed 2',
    'beech': '--height 20 --diameter 0.9 --seed 1',
    'horse_chestnut': '--height 16 --diameter 0.85 --seed 1',
    'willow': '--height 12 --diameter 0.95 --seed 1',
    'walnut': '--height 8 --diameter 0.32 --seed 2',
}
"""Individuals by their options of `tree-sway grow`: most have stood in the open all their life."""
SQUARE = 1200, 1200
"""Size of the picture of one tree [px]."""
LARGE, SMALLER = 960, 0.75
"""Width from which a picture is saved smaller than it was taken [px], and by how much."""
AVENUE = 'x,y,species,height\n' + ''.join(
    f'{10 * row},{9 * place},lime,14\n' for place in range(10) for row in range(2)
)
_EVENING = "document.getElementById('theme').click();"
_OPEN, _CLOSED = (f"document.getElementById('panel').open = {so}" for so in ('true', 'false'))
_CLOSE, _NEARLY, _WHOLE = (f'treeSway.scene.camera.zoom({by});' for by in (0.86, 0.92, 1.08))
_MAY = 'treeSway.scene.flower(5.5);'
_TRACED = 'treeSway.traces.wind._shown.points.length > 1'
_AUTUMN = "document.getElementById('season').click();"


@dataclass(frozen=True)
class View:
    """A picture: of which tree, in which quality and size [px], and what is done before it."""

    name: str
    tree: str
    is_full: bool = True
    script: str = ''
    is_dark: bool = False
    size: tuple[int, int] = (1280, 800)
    is_film: bool = False
    has_cards: bool = False


_BARE = """
for (const each of document.querySelectorAll('.card, #tools')) each.style.display = 'none';
document.querySelector('main').style.gridArea = '1 / 1 / -1 / -1';
treeSway.scene.hasArrow = treeSway.scene.hasPerson = false;
treeSway.scene.camera.home();
"""
"""
Hides the instruments, the arrow of the wind and the person (key M), and fits the tree into the
whole picture.
"""

DRAWN = 300.0
"""Until the first pictures of a thousand trees are drawn in full quality on a processor [s]."""

COARSE = 0.2
"""Pixels per pixel of the page, each way, until the last pictures, the first with leaves."""

SETTLING = 15.0
"""Until a page without a graphics unit has chosen what it leaves out [s]."""

FILM, EVERY, FILM_SIZE = 5.0, 0.1, (640, 400)
"""Length of a film and time between its pictures [s], and their size [px]: each is drawn anew."""

VIEWS = (
    View('benjamina', 'benjamina', script=_CLOSE, size=SQUARE),
    View('benjamina_near', 'benjamina', script='treeSway.scene.camera.zoom(0.3)'),
    View('benjamina_software', 'benjamina', is_full=False),
    View('benjamina_dark', 'benjamina', is_dark=True, has_cards=True),
    View('goldcrest', 'goldcrest', script=_WHOLE, size=SQUARE),
    View('oak', 'oak', script=_NEARLY, size=SQUARE),
    View('oak_autumn', 'oak', script=_EVENING + _AUTUMN),
    View('birch', 'birch', script=_CLOSE, size=SQUARE),
    View('spruce', 'spruce', script=_CLOSE, size=SQUARE),
    View('spruce_software', 'spruce', is_full=False),
    View('fir', 'fir', script=_CLOSE, size=SQUARE),
    View('pine', 'pine', script=_NEARLY, size=SQUARE),
    View('pine_near', 'pine', script='treeSway.scene.camera.zoom(0.35)'),
    View('lime', 'lime', script=_CLOSE, size=SQUARE),
    View('beech', 'beech', script=_CLOSE, size=SQUARE),
    View('horse_chestnut', 'horse_chestnut', script=_CLOSE + _MAY, size=SQUARE),
    View('willow', 'willow', script=_NEARLY, size=SQUARE),
    View('willow_sways', 'willow', is_film=True, size=FILM_SIZE),
    View('walnut', 'walnut', script=_WHOLE, size=SQUARE),
    View('walnut_software', 'walnut', is_full=False),
    View('walnut_near', 'walnut', script='treeSway.scene.camera.zoom(0.35)'),
    View('walnut_far', 'walnut', script='treeSway.scene.camera.zoom(4)'),
    View('avenue', 'avenue', script='treeSway.scene.camera.set([-1.55, 0.06, 62, 5, 30, 6])'),
    *(
        View(f'phone_{size[0]}{name}', 'birch', size=size, script=script, has_cards=True)
        for size in ((390, 844), (844, 390), (768, 1024))
        for name, script in (('', _CLOSED), ('_open', _OPEN))
    ),
    View('stand', str(STAND)),
    View('stand_software', str(STAND), is_full=False),
    View('stand_near', str(STAND), is_full=False, script='treeSway.scene.camera.zoom(0.86)'),
)


def main() -> None:
    """Take all pictures, or those that are named."""
    parser = argparse.ArgumentParser()
    parser.add_argument('folder', type=Path)
    parser.add_argument('names', nargs='*')
    parser.add_argument('--walnut', help='a scanned walnut; one is grown if left out')
    given = parser.parse_args()
    given.folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as grown:
        for view in VIEWS:
            if not given.names or view.name in given.names:
                tree = view.tree
                if tree == 'walnut' and given.walnut:
                    tree = given.walnut
                elif tree == 'avenue':
                    tree = f'{grown}/avenue.csv'
                    Path(tree).write_text(AVENUE, encoding='utf-8')
                elif tree in GROWN:
                    tree = f'{grown}/{tree}.yaml'
                    words = ['--species', view.tree, *GROWN[view.tree].split()]
                    if not Path(tree).exists():
                        cli.main(['grow', *words, '-o', tree])
                print(view.name, file=sys.stderr, flush=True)
                take(view, tree, given.folder / f'{view.name}.jpg')


def take(view: View, tree: str, path: Path) -> None:
    """Take one picture."""
    parser = argparse.ArgumentParser()
    show.add_arguments(parser)
    wood = () if view.tree != 'walnut' else ('--species', 'walnut')  # which a scan does not state
    arguments = parser.parse_args([tree, *wood])
    choices, wind = Choices(Path(tree).name), SimulatedWind(9.0)
    session = Session(lambda wanted: show.build_scene(wanted, arguments), choices, wind)
    controls = page_controls(choices, wind) if view.has_cards else ()
    panel = ControlPanel(controls, session.apply, session.pull)
    panel.update(session.values())
    with PageServer(PageSettings(port=0), panel, session.status) as server:
        session.serve(server)
        try:
            asyncio.run(look(server.url, view, path))
        finally:
            session.stop()


async def look(url: str, view: View, path: Path) -> None:
    """Open the page, wait until the tree sways, and save what is seen."""
    width, height = view.size
    async with Browser() as browser:
        address = f'{url}?quality=full' if view.is_full else url
        scale = COARSE if view.is_full else 1.0
        await browser.open(address, width=width, height=height, dark=view.is_dark, scale=scale)
        await browser.until('window.treeSway', DRAWN)
        if view.is_full:
            await browser.run('treeSway.scene.leavesShown = false')
        live = "window.treeSway && treeSway.state === 'live' && treeSway.fps > 0"
        await browser.until(live, DRAWN)
        if not view.has_cards:
            await browser.run(_BARE)
        if view.script:
            await browser.run(view.script)
        await browser.until('treeSway.traces.wind._points.length > 6', DRAWN)
        if view.is_full:
            await browser.run('treeSway.scene.leavesShown = true')
            await browser.call(
                'Emulation.setDeviceMetricsOverride',
                width=width, height=height, deviceScaleFactor=1, mobile=width < 700,
            )  # fmt: skip
        drawn = await browser.run('treeSway.scene._frame')
        await browser.until(f'treeSway.scene._frame > {drawn} + 2', DRAWN)
        if view.has_cards:
            await browser.until(f'{live} && {_TRACED}', DRAWN)
        if not view.is_full:
            await settled(browser)
        if view.is_film:
            await film(browser, path.with_suffix('.webp'))
            return
        image = Image.open(io.BytesIO(await browser.screenshot())).convert('RGB')
        if width > LARGE:
            size = round(SMALLER * width), round(SMALLER * height)
            image = image.resize(size, Image.Resampling.LANCZOS)
        image.save(path, quality=82, optimize=True)
        print(path, path.stat().st_size, await browser.run('treeSway.fps'), browser.console)


async def settled(browser: Browser) -> None:
    """Wait while the page chooses what it draws; on a busy machine it never ends."""
    begun = await browser.run('treeSway.scene.quality._from')
    await browser.until(f'treeSway.scene.quality._from > {begun} + {1e3 * SETTLING}')


async def film(browser: Browser, path: Path) -> None:
    """Look back over the last seconds, a picture at a time."""
    oldest = 'treeSway.playout._frames[0].stamp'
    await browser.until(f'treeSway.playout.newest > {oldest} + {1e3 * FILM}', DRAWN)
    pictures: list[Image.Image] = []
    count = round(FILM / EVERY)
    for number in range(count):
        slide = f"s.value = {number * EVERY - FILM}; s.dispatchEvent(new Event('input'))"
        await browser.run(f"{{const s = document.getElementById('time'); {slide};}}")
        drawn = await browser.run('treeSway.scene._frame')
        await browser.until(f'treeSway.scene._frame > {drawn} + 1', DRAWN)
        image = Image.open(io.BytesIO(await browser.screenshot())).convert('RGB')
        pictures.append(image)
        print(f'\r{path}: {len(pictures)} of {count}', end='', file=sys.stderr, flush=True)
    print(file=sys.stderr)
    first, *others = pictures
    first.save(
        path, save_all=True, append_images=others, duration=round(1e3 * EVERY), loop=0, quality=70
    )
    print(path, path.stat().st_size)


if __name__ == '__main__':
    main()
