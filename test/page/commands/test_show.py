# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``tree-sway show`` as a user starts it: a page with a moving tree, and what it refuses."""

from __future__ import annotations

import argparse
import asyncio
from dataclasses import replace
import json
from pathlib import Path
import re
import socket
import subprocess
import sys
import threading
from typing import Any

import numpy as np
import pytest

aiohttp = pytest.importorskip('aiohttp', reason='aiohttp is not installed')

from tree_sway.commands.cli import main  # noqa: E402
from tree_sway.core.scene.scene_simulator import Simulator  # noqa: E402
from tree_sway.core.settings import model_of, USUAL  # noqa: E402
from tree_sway.errors import ParameterError  # noqa: E402
from tree_sway.forest.commands.on_the_page import RiskOnThePage  # noqa: E402
from tree_sway.growth.growing import grow  # noqa: E402
from tree_sway.page.commands import show  # noqa: E402
from tree_sway.page.commands.page_arguments import page_settings  # noqa: E402
from tree_sway.page.commands.page_controls import page_controls  # noqa: E402
from tree_sway.page.session import Choices  # noqa: E402
from tree_sway.simulation.wind_source import RecordedWind, SimulatedWind  # noqa: E402
from tree_sway.stream.controls import Control, Value  # noqa: E402
from tree_sway.stream.protocol import decode_description, decode_frame  # noqa: E402
from tree_sway.twin.commands.on_the_page import SensorsOnThePage  # noqa: E402

ROOT = Path(__file__).resolve().parents[3]
SEEDLING = ROOT / 'test' / 'files' / 'data' / 'seedling.yaml'
QUICK = 'branch'
"""Model that is prepared soonest, for tests of the tree alone."""
DEADLINE = 120.0


def shown(*words: str) -> argparse.Namespace:
    """Return the arguments of the command."""
    parser = argparse.ArgumentParser()
    show.add_arguments(parser)
    return parser.parse_args(words)


def test_the_page_is_served_and_the_tree_moves() -> None:
    command = [sys.executable, '-m', 'tree_sway', 'show', str(SEEDLING)]
    command += ['--port', '0', '--stand', '2']
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, cwd=ROOT)
    timer = threading.Timer(DEADLINE, process.kill)
    timer.start()
    try:
        assert process.stdout is not None
        url = next(found[1] for line in process.stdout if (found := re.search(r'(http\S+)', line)))

        async def look() -> None:
            async with (
                aiohttp.ClientSession() as session,
                session.ws_connect(f'{url}stream') as ws,
            ):
                await ws.send_json({'credit': 64})
                description, states, controls = None, set(), {}
                while len(states) < 10:
                    message = await asyncio.wait_for(ws.receive(), DEADLINE)
                    if message.type is aiohttp.WSMsgType.TEXT:
                        hello = json.loads(message.data).get('hello')
                        if hello:
                            controls = {each['name']: each for each in hello['controls']}
                    elif message.data[:4] == b'TSWD':
                        description = decode_description(message.data)
                    else:
                        states.add(decode_frame(message.data).coordinates.tobytes())
                assert [tree['name'] for tree in description.header['trees']] == [
                    'seedling1',
                    'seedling2',
                ]
                assert {'mean_speed', 'model', 'tree', 'pause'} <= set(controls)
                # By their names: no path of this machine, no model that there is not.
                tree, count, model = (controls[name] for name in ('tree', 'count', 'model'))
                assert (tree['value'], count['value']) == ('seedling.yaml', '2')
                assert not [each for each in tree['choices'] if '/' in each]
                assert model['value'] == str(USUAL)
                assert [model_of(each) for each in model['choices']]

        asyncio.run(look())
    finally:
        timer.cancel()
        process.kill()
        process.wait()
        process.stdout.close()


@pytest.mark.parametrize(
    ('arguments', 'expected'),
    [
        (['--address', '0.0.0.0'], 'without a token'),
        (['--port', '70000'], '--port: 70000 is out of range'),
        (['--stand', '0'], '--stand: 0 is out of range'),
        (['--speed', '400'], 'out of range'),
        (['--wind', 'no_such.csv'], 'no_such.csv'),
    ],
)
def test_what_cannot_be_served_is_refused_in_words(
    arguments: list[str], expected: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(['show', str(SEEDLING), '--seconds', '0', *arguments]) == 2
    assert expected in capsys.readouterr().err


def test_a_wrong_tree_is_told_before_a_sensor_is_connected(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    wrong = tmp_path / 'wrong.yaml'
    wrong.write_text('branches: 3\n')
    with socket.create_server(('127.0.0.1', 0)) as server:
        server.settimeout(0.0)
        source = f'tcp://127.0.0.1:{server.getsockname()[1]}'
        assert main(['show', str(wrong), '--sensor', source, '--port', '0', '--seconds', '0']) == 2
        with pytest.raises(BlockingIOError):  # nobody has called
            server.accept()
    assert 'wrong.yaml' in capsys.readouterr().err


def test_a_stand_of_a_file_offers_neither_a_model_nor_a_number_of_trees() -> None:
    """Its trees have models of their own, and are as many as the file has."""
    choices, wind = show.Choices('stand.yaml', '1', str(USUAL)), SimulatedWind(6.0)
    of_a_tree = {each.name for each in page_controls(choices, wind)}
    of_a_stand = {each.name for each in page_controls(choices, wind, is_one_tree=False)}
    assert of_a_tree - of_a_stand == {'model', 'count'}


def test_a_viewer_grows_a_tree_of_a_species_and_a_height() -> None:
    arguments = shown(str(SEEDLING))
    wanted = show.Choices('birch', height=4.0, model=QUICK)
    heights, starts = [], []
    for choices in (wanted, wanted, replace(wanted, individual='1', height=5.5)):
        tree = show.build_scene(choices, arguments).tree
        heights.append(round(tree.height, 6))
        starts.append(tree.start.tobytes())
    assert heights == [4.0, 4.0, 5.5]
    assert starts[0] == starts[1] != starts[2]


def test_age_thickens_the_stem_of_a_tree_that_is_grown() -> None:
    arguments = shown(str(SEEDLING))
    wanted = show.Choices('lime', height=9.0, model=QUICK)
    trees = [
        show.build_scene(replace(wanted, age=age), arguments).tree for age in (0.0, 15.0, 40.0)
    ]
    stems = [tree.base_diameter[0] for tree in trees]
    assert stems[1] < stems[2]
    assert stems[0] != stems[1]
    with pytest.raises(ParameterError, match='no curve of growth'):
        show.build_scene(show.Choices('willow', height=9.0, age=15.0), arguments)


def test_a_tree_that_is_grown_has_the_leaves_of_a_month() -> None:
    arguments = shown(str(SEEDLING))
    wanted = show.Choices('birch', height=4.0, model=QUICK)
    summer, autumn, winter = (
        show.build_scene(replace(wanted, month=month), arguments) for month in (7.0, 11.0, 2.0)
    )
    areas = [each.settings.leaf_area.sum() for each in (summer, autumn)]
    assert 0.0 < areas[1] < 0.9 * areas[0]
    assert not winter.settings.in_leaf
    assert winter.settings.leaf_area is None
    assert (
        autumn.models[0].species.look.green
        == autumn.models[0].species.look.autumn
        != summer.models[0].species.look.green
    )


@pytest.mark.parametrize(
    ('tree', 'is_grown'), [('birch', True), ('goldcrest', False), ('oak.yaml', False)]
)
def test_only_a_species_that_is_no_built_in_tree_is_grown(tree: str, is_grown: bool) -> None:
    choices = Choices(tree)
    assert choices.is_grown is is_grown
    controls = {each.name: each for each in page_controls(choices, SimulatedWind(6.0))}
    offered = controls['tree'].choices
    assert tree in offered
    assert {'oak', 'spruce', 'ginkgo', 'benjamina'} <= set(offered)
    assert len(set(offered)) == len(offered)
    low, high = controls['height'].minimum, controls['height'].maximum
    for key in ('birch', 'spruce'):
        for height in (low, high):
            assert grow(key, height, rng=np.random.default_rng(0)).height == pytest.approx(height)


def test_a_table_of_risk_colours_the_trees_that_it_names(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    table = tmp_path / 'risk.csv'
    table.write_text('name,low_80 [m/s],high_80 [m/s]\nseedling,20,30\nother,,\n')
    risk = RiskOnThePage(argparse.Namespace(risk=str(table)))
    assert risk.critical_winds(('seedling', 'other')) == {'seedling': (20.0, 30.0)}
    assert RiskOnThePage(argparse.Namespace(risk=None)).critical_winds(('seedling',)) is None
    for text, message in (
        (
            'name,low_80 [m/s],high_80 [m/s]\na,1,2\n',
            'no tree is called as one of the table, such as',
        ),
        ('name,speed\na,1\n', "no column 'low_80 [m/s]'"),
        ('name,low_80 [m/s],high_80 [m/s]\nseedling,1,x\n', "line 2: 'x' is no wind speed"),
    ):
        table.write_text(text)
        arguments = ['show', str(SEEDLING), '--risk', str(table), '--port', '0', '--seconds', '1']
        assert main(arguments) == 2
        assert message in capsys.readouterr().err


def test_what_is_added_lists_its_facts_and_does_what_its_control_asks(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    seen: list[object] = []

    class Doubled(show.PageAddition):
        factor = 1.0

        def controls(self) -> tuple[Control, ...]:
            return (Control('factor', 'Factor', 1.0, minimum=0.0, maximum=9.0),)

        def apply(self, name: str, value: Value) -> bool:
            if name != 'factor':
                return False
            self.factor = float(value or 0.0)
            return True

        def facts(self, simulator: Simulator) -> dict[str, str]:
            return {'Height': f'{self.factor * simulator.tree.height:.2f} m'}

    class Watched(show.PageServer):
        def __init__(self, settings: Any, panel: Any, status: Any, *others: Any) -> None:
            super().__init__(settings, panel, status, *others)
            seen.extend([status()['facts'], panel.set('factor', 2.0), status()['facts']])
            seen.extend([panel.set('pause', True), panel.values()['factor']])

    monkeypatch.setattr(show, 'additions', lambda _: [Doubled])
    monkeypatch.setattr(show, 'PageServer', Watched)
    given = ['show', str(SEEDLING), '--port', '0', '--seconds', '0', '--model', QUICK]
    assert main(given) == 0
    before, *_, after, refusal, factor = seen
    assert (refusal, factor) == (None, 2.0)
    lengths = [float(each['Height'].split()[0]) for each in (before, after)]  # type: ignore[index]
    assert lengths[1] == pytest.approx(2.0 * lengths[0], abs=0.02)


def test_a_viewer_switches_between_the_expected_wind_and_a_sample() -> None:
    arguments = shown(str(SEEDLING), '--anemometer-distance', '12', '--anemometer-bearing', '270')
    choices = Choices(str(SEEDLING.name), model='20', anemometer_distance=12.0)
    told = {
        gusts: show.build_scene(replace(choices, gusts=gusts), arguments).wind_told
        for gusts in ('expected', 'sample', 'measured')
    }
    assert re.match('the expected wind; anemometer 12 m away at 270 degrees', told['expected'])
    assert re.search(r'a sample, seed 0; .* \d\d% of their power told', told['sample'])
    assert told['measured'].startswith('as measured; anemometer 12 m away')
    beside = show.build_scene(replace(choices, anemometer_distance=0.0), arguments)
    assert 'taken to stand at the tree' in beside.wind_told
    names = {each.name: each for each in page_controls(choices, SimulatedWind(5.0))}
    assert (names['gusts'].value, names['anemometer_distance'].value) == ('sample', 12.0)


@pytest.mark.parametrize(('address', 'is_warned'), [('0.0.0.0', True), ('127.0.0.1', False)])
def test_links_without_a_certificate_are_warned_of(
    address: str, is_warned: bool, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    token = tmp_path / 'token'
    given = ['show', str(SEEDLING), '--port', '0', '--seconds', '0.1', '--model', QUICK]
    assert main([*given, '--address', address, '--token-file', str(token)]) == 0
    assert ('without a certificate everybody' in capsys.readouterr().err) is is_warned


def test_each_control_of_the_page_has_its_hint_in_all_languages() -> None:
    words = json.loads((ROOT / 'tree_sway/page/static/words.json').read_text(encoding='utf-8'))
    wind = RecordedWind(np.arange(3.0), np.zeros((3, 3)))
    choices = Choices('oak')
    controls = [*page_controls(choices, SimulatedWind(5.0)), *page_controls(choices, wind)]
    sensors = SensorsOnThePage(argparse.Namespace(learn=None, motion=['udp:5006'], stand=1))
    sensors.places = {'phone': '3.2'}
    controls += sensors.controls()
    described = {each.name for each in controls if each.description}
    assert 'sensor_at' in described
    assert [name for name in sorted(described) if len(words.get(f'{name}_hint', [])) != 4] == []


@pytest.mark.parametrize(
    ('given', 'cure'),
    [
        ('localhost:5173', 'http://localhost:5173'),
        ('https://example.org/page', 'https://example.org'),
    ],
)
def test_an_origin_that_no_browser_sends_is_refused_with_the_right_one(
    given: str, cure: str
) -> None:
    with pytest.raises(ParameterError, match=f'--origin {cure}$'):
        page_settings(shown('goldcrest', '--origin', given))
    assert page_settings(shown('goldcrest', '--origin', cure)).origins == (cure,)
