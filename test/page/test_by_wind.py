# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The wind alone on the line: who solves by it, and how near its picture stays."""

from __future__ import annotations

import base64
from collections.abc import Iterator
from dataclasses import replace
import json
from pathlib import Path
import shutil
import subprocess
from typing import Any

import numpy as np
import pytest

pytest.importorskip('aiohttp', reason='aiohttp is not installed')

from tree_sway.core.scene.scene import Scene  # noqa: E402
from tree_sway.core.settings import Settings  # noqa: E402
from tree_sway.core.wind.turbulence import simulate_turbulence  # noqa: E402
from tree_sway.errors import TransportError  # noqa: E402
from tree_sway.files.trees.source import open_scene  # noqa: E402
from tree_sway.page.page_client import MOST_IN_STATE, PageClient  # noqa: E402
from tree_sway.page.page_settings import PageSettings  # noqa: E402
from tree_sway.page.server import PageServer  # noqa: E402
from tree_sway.stream.by_wind import ByWind, STEP  # noqa: E402
from tree_sway.stream.client import StreamClient  # noqa: E402
from tree_sway.stream.protocol import (  # noqa: E402
    decode_description,
    decode_frame,
    decode_tables,
    FRAME_SIZE,
    part_of_frame,
)
from tree_sway.stream.scene_state import SceneState  # noqa: E402

HERE = Path(__file__).parent
MINUTES = 10


class Run:
    """Ten minutes of a tree in wind as frames, and what of them a client by wind is sent."""

    def __init__(self) -> None:
        self.simulator: Any = open_scene('goldcrest').simulator(Settings(), model=20)
        self.state = SceneState(self.simulator)
        self.simulator.reset()
        client, seconds = PageClient(None, None), 60.0 * MINUTES  # type: ignore[arg-type]
        rng = np.random.default_rng(5)
        wind = simulate_turbulence(7.0, duration=seconds, rate=20.0, rng=rng)
        self.whole, self.sent = [], []
        for step in range(round(seconds / STEP)):
            self.simulator.step(wind[step // 3], STEP)
            frame = self.state.frame(round(1e9 * STEP * step))
            self.whole.append(frame)
            self.sent.append(client.thinned(frame, STEP * step))


@pytest.fixture(scope='module')
def run() -> Run:
    return Run()


def test_a_frame_of_wind_alone_is_28_bytes(run: Run) -> None:
    sizes = np.array([len(frame) for frame in run.sent])
    assert FRAME_SIZE == 28
    assert (sizes == 28).mean() > 0.99
    assert sizes.sum() / (60.0 * MINUTES) < 1_800.0
    alone = decode_frame(run.sent[2])
    assert len(alone.coordinates) == 0
    assert alone.wind == pytest.approx(decode_frame(run.whole[2]).wind)


def test_a_stand_of_a_thousand_trees_fits_a_thin_line() -> None:
    client, sent = PageClient(None, None), 0  # type: ignore[arg-type]
    frame = bytes(FRAME_SIZE - 2) + (20_384).to_bytes(2, 'little') + bytes(2 * 20_384)
    for step in range(2 * 60):
        client.thinned(frame, step / 60.0)  # two whole states to begin with
    firsts = []
    for step in range(2 * 60, 602 * 60):
        part = client.thinned(frame, step / 60.0)
        sent += len(part) + 2  # and the header of a WebSocket's message
        if len(part) > FRAME_SIZE:
            firsts.append(int.from_bytes(part[FRAME_SIZE : FRAME_SIZE + 2], 'little'))
    assert sent / 600.0 <= 2_500.0
    assert set(firsts) == set(range(0, 20_384, MOST_IN_STATE))


def test_a_part_of_a_frame_reads_back(run: Run) -> None:
    description, whole = decode_description(run.state.description), decode_frame(run.whole[99])
    part = decode_frame(part_of_frame(run.whole[99], 3, 5))
    expected = description.coordinates(whole)
    assert part.first == 3
    np.testing.assert_array_equal(description.coordinates(part), expected[3:8])
    last = decode_frame(part_of_frame(run.whole[99], len(expected) - 2, 5))
    assert len(last.coordinates) == 2


def test_who_solves_in_python_stays_near(run: Run) -> None:
    description = decode_description(run.state.description)
    tables = run.state.tables()
    assert tables is not None
    solver = ByWind(description, decode_tables(tables).scene(description, STEP))
    rng, farthest, motion = np.random.default_rng(2), 0.0, 0.0
    for number, (sent, whole) in enumerate(zip(run.sent[:7200], run.whole[:7200], strict=True)):
        if number > 2 and len(sent) == FRAME_SIZE and rng.random() < 0.01:
            continue
        found = solver.take(decode_frame(sent))
        expected = description.coordinates(decode_frame(whole))
        assert found is not None
        if number > 600:
            farthest = max(farthest, float(np.abs(found - expected).max()))
            motion = max(motion, float(np.abs(expected).max()))
    assert solver.corrections >= 7200 // 300
    assert farthest < 0.05 * motion


def test_two_pages_that_lose_frames_meet_at_each_state(run: Run, tmp_path: Path) -> None:
    node = shutil.which('node')
    if node is None:
        pytest.skip('node is not installed here')
    tables = run.state.tables()
    assert tables is not None
    (tmp_path / 'description.bin').write_bytes(run.state.description)
    (tmp_path / 'tables.bin').write_bytes(tables)
    frames = b''.join(len(frame).to_bytes(4, 'little') + frame for frame in run.sent)
    (tmp_path / 'frames.bin').write_bytes(frames)
    command = [node, str(HERE / 'by_wind_pages.mjs'), str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=300)
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    print(found)
    assert found['states'] == found['corrections'] - 1 >= 60 * MINUTES // 5 - 1
    assert min(found['lost']) > 300
    assert found['after'] <= 1e-3
    assert found['before'] <= 0.05


class Stand:
    """A stand in gusts: frames for a page from the start, and for one that comes late."""

    JOINED, STEPS = 3000, 4200

    def __init__(self) -> None:
        one = open_scene('goldcrest').trees[0]
        trees = [replace(one, name=f't{k}', x=35.0 * k) for k in range(3)]
        simulator: Any = Scene(trees).simulator(Settings(model=20))
        self.state = SceneState(simulator)
        simulator.reset()
        older, late = (PageClient(None, None) for _ in range(2))  # type: ignore[arg-type]
        rng = np.random.default_rng(6)
        wind = simulate_turbulence(7.0, duration=self.STEPS * STEP, rate=20.0, rng=rng)
        self.frames, self.joining, self.gusts = [], [], ''
        for step in range(self.STEPS):
            if step == self.JOINED:
                self.gusts = json.dumps(self.state.gusts())
            simulator.step(wind[step // 3], STEP)
            frame = self.state.frame(round(1e9 * STEP * step))
            self.frames.append(older.thinned(frame, STEP * step))
            if step >= self.JOINED:
                self.joining.append(late.thinned(frame, STEP * step))
        self.delay = float(simulator.gusts.delay.max())


@pytest.fixture(scope='module')
def stand() -> Stand:
    return Stand()


def test_who_comes_late_to_a_stand_feels_the_gusts_of_before(stand: Stand) -> None:
    assert stand.delay > 5.0
    assert len(stand.gusts) < 50_000
    description = decode_description(stand.state.description)
    tables = decode_tables(stand.state.tables() or b'')
    older, late, bare = (ByWind(description, tables.scene(description, STEP)) for _ in range(3))
    late.go_on(json.loads(stand.gusts))
    apart = without = motion = 0.0
    for number, data in enumerate(stand.frames):
        there = older.take(decode_frame(data))
        if number >= stand.JOINED:
            frame = decode_frame(stand.joining[number - stand.JOINED])
            found, other = late.take(frame), bare.take(frame)
            assert there is not None
            assert found is not None
            assert other is not None
            apart = max(apart, float(np.abs(found - there).max()))
            without = max(without, float(np.abs(other - there).max()))
            motion = max(motion, float(np.abs(there).max()))
    print(f'{apart / motion:.4f} of the motion apart, {without / motion:.4f} without the gusts')
    assert apart < 0.01 * motion < 0.1 * motion < without


def test_a_page_that_comes_late_does_so_too(stand: Stand, tmp_path: Path) -> None:
    node = shutil.which('node')
    if node is None:
        pytest.skip('node is not installed here')
    (tmp_path / 'description.bin').write_bytes(stand.state.description)
    (tmp_path / 'tables.bin').write_bytes(stand.state.tables() or b'')
    frames, joining = (
        [base64.b64encode(each).decode() for each in which]
        for which in (stand.frames, stand.joining)
    )
    given = {'frames': frames, 'joining': joining, 'joined': stand.JOINED}
    text = json.dumps({**given, 'gusts': json.loads(stand.gusts)})
    (tmp_path / 'frames.json').write_text(text, encoding='utf-8')
    command = [node, str(HERE / 'late_page.mjs'), str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=120)
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    print(found)
    assert found['apart'] < 0.01 < 0.1 < found['without']


@pytest.fixture
def server(run: Run) -> Iterator[PageServer]:
    with PageServer(PageSettings(port=0)) as made:
        yield made


def test_a_client_by_wind_solves_what_a_server_describes(run: Run, server: PageServer) -> None:
    server.describe(run.state.description, run.state.tables)
    with StreamClient(server.url, rate=1000.0, by_wind=True) as client:
        for frame in run.whole:
            server.publish(frame)
            try:
                client.wait(0.02, frames=30)
            except TransportError:  # not yet: the next frame is published
                continue
            break
        assert client.solver is not None
        assert client.solver.corrections >= 1
        assert client.poses() is not None


def test_a_client_is_sent_the_gusts_as_it_joins(stand: Stand, server: PageServer) -> None:
    heard = json.loads(stand.gusts)
    server.describe(stand.state.description, stand.state.tables, lambda: heard)
    with StreamClient(server.url, rate=1000.0, by_wind=True) as client:
        # Once: each frame that comes is a step on, and a server keeps the newest for who joins.
        server.publish(stand.joining[0])
        client.wait(60.0)
        assert client.solver is not None
        gusts = client.solver._scene.gusts
        found = gusts.recent(gusts.time)
        assert np.abs(np.subtract(found['delay'], heard['delay'])).max() < 0.1
        assert len(found['wind']) == len(heard['wind'])
        assert client.unreadable == 0


def test_a_scene_without_tables_comes_state_by_state(run: Run, server: PageServer) -> None:
    server.describe(run.state.description)
    with StreamClient(server.url, rate=1000.0, by_wind=True) as client:
        for frame in run.whole[:2000]:
            server.publish(frame)
            try:
                client.wait(0.02, frames=5)
            except TransportError:
                continue
            break
        assert client.solver is None
        assert 'cannot be solved by clients' in client.problem
