# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The viewer over real DDS: the page gets from topics what rebuilds the solver's own poses."""

import asyncio
import json
import threading
import time

import numpy as np
import pytest

pytest.importorskip('rclpy', reason='ROS 2 is not installed')
aiohttp = pytest.importorskip('aiohttp', reason='aiohttp is not installed')
pytestmark = pytest.mark.ros

from rclpy.serialization import deserialize_message  # noqa: E402

from tree_sway.page.page_settings import PageSettings  # noqa: E402
import tree_sway.page.server as server_module  # noqa: E402
from tree_sway.page.server import PageServer  # noqa: E402
from tree_sway.stream.client import StreamClient  # noqa: E402
from tree_sway.stream.placing import Placer  # noqa: E402
from tree_sway.stream.protocol import (  # noqa: E402
    decode_description,
    decode_frame,
    PAUSED,
    WIND_LOST,
)
from tree_sway_ros.nodes.viewer import USUAL_OR_FREE  # noqa: E402
from tree_sway_ros.process.topics import (  # noqa: E402
    message_class,
    SEGMENT_POSES,
    TREE_DESCRIPTION,
    TREE_STATE,
    WIND,
)
from tree_sway_ros.reports.diagnostics import WARN  # noqa: E402
from tree_sway_ros.wire.tree_state import (  # noqa: E402
    ModalState,
    read_state,
    read_state_entry,
    StateWriter,
)
from tree_sway_ros.wire.wind_messages import stamp_to_ns  # noqa: E402

DEADLINE = 60.0
QUIET = {'control': True, 'port': 0}


def test_poses_are_rebuilt_from_state_and_description(compose, observer, tree_file):
    compose(anemometer={'rate': 50.0}, wind={}, solver={'tree': tree_file})
    described = observer.listen(TREE_DESCRIPTION)
    states, poses = observer.listen(TREE_STATE), observer.listen(SEGMENT_POSES)
    observer.until(lambda: len(states) > 20, 'states', DEADLINE)
    data = read_state_entry(json.loads(described[-1].data))
    description = decode_description(data)
    by_stamp = {stamp_to_ns(each.header.stamp): each for each in poses}
    read = [read_state(each) for each in states[::-1]]
    state = next(each for each in read if each.stamp in by_stamp)
    solved = by_stamp[state.stamp].poses
    exact = np.array([[p.position.x, p.position.y, p.position.z] for p in solved])
    placer = Placer(description)
    rebuilt = placer.place(state.coordinates)
    at_rest = placer.place(np.zeros(len(description.scale)))
    moved = np.linalg.norm(exact - at_rest[:, :3])
    assert moved > 1e-4
    assert np.linalg.norm(rebuilt[:, :3] - exact, axis=1).max() < 1e-3


def test_the_page_is_fed_and_passes_changes_on(compose, observer, tree_file):
    nodes = compose(anemometer={}, wind={}, solver={'tree': tree_file}, viewer=QUIET)
    url = nodes['viewer'].server.url
    said = []

    async def look():
        async with aiohttp.ClientSession() as session, session.ws_connect(f'{url}stream') as ws:
            await ws.send_json({'credit': 64})
            description, frames = None, 0
            while frames < 5:
                message = await asyncio.wait_for(ws.receive(), DEADLINE)
                if message.type is not aiohttp.WSMsgType.BINARY:
                    continue
                if message.data[:4] == b'TSWD':
                    description = decode_description(message.data)
                else:
                    frame = decode_frame(message.data)
                    frames += 1
            Placer(description).place(description.coordinates(frame))
            for name, value in (('mean_speed', 11.5), ('mean_speed', 500.0), ('reset', None)):
                await ws.send_json({'set': {'name': name, 'value': value}})
            while not said or 'refused' not in said[-1]:
                message = await asyncio.wait_for(ws.receive(), DEADLINE)
                if message.type is aiohttp.WSMsgType.TEXT:
                    said.append(message.data)

    asyncio.run(look())
    assert 'out of range' in said[-1]
    end = time.monotonic() + DEADLINE
    while nodes['anemometer'].values['mean_speed'] != 11.5:
        assert time.monotonic() < end
        threading.Event().wait(0.01)


def test_the_usual_port_or_a_free_one(compose, monkeypatch):
    with PageServer(PageSettings(port=0)) as other:
        monkeypatch.setattr(server_module, 'USUAL_PORT', other.port)
        nodes = compose(viewer={'port': USUAL_OR_FREE})
        assert nodes['viewer'].server.port not in (0, other.port)


def wind_of_status(url, holds):
    """Return the wind in the status of a page, once it is as wanted."""

    async def look():
        async with aiohttp.ClientSession() as session, session.ws_connect(f'{url}stream') as ws:
            end = time.monotonic() + DEADLINE
            while time.monotonic() < end:
                message = await asyncio.wait_for(ws.receive(), DEADLINE)
                if message.type is aiohttp.WSMsgType.TEXT and 'status' in message.data:
                    wind = json.loads(message.data)['status']['wind']
                    if holds(wind):
                        return wind
            return None

    return asyncio.run(look())


def test_the_page_knows_a_simulated_wind(compose, tree_file):
    nodes = compose(anemometer={}, wind={}, solver={'tree': tree_file}, viewer=QUIET)
    url = nodes['viewer'].server.url
    assert wind_of_status(url, lambda wind: wind['kind'] != 'none') == {'kind': 'simulated'}


def test_the_page_knows_a_live_wind_and_its_rate(compose, observer, tree_file):
    nodes = compose(wind={}, solver={'tree': tree_file}, viewer=QUIET)
    url = nodes['viewer'].server.url
    assert wind_of_status(url, lambda wind: True) == {'kind': 'none'}
    publisher, is_over = observer.publisher(WIND), threading.Event()

    def measure():
        message = message_class(WIND)()
        message.vector.x = 5.0
        while not is_over.wait(0.05):
            message.header.stamp = observer.node.get_clock().now().to_msg()
            publisher.publish(message)

    mast = threading.Thread(target=measure)
    mast.start()
    try:
        wind = wind_of_status(url, lambda wind: wind.get('rate', 0.0) > 10.0)
    finally:
        is_over.set()
        mast.join()
    assert wind is not None
    assert wind['kind'] == 'live'
    assert wind['name'].endswith('/wind')
    assert wind['rate'] < 22.0


def test_a_page_without_solver_says_what_is_missing(compose):
    nodes = compose(viewer=QUIET)
    url = nodes['viewer'].server.url

    async def look():
        async with aiohttp.ClientSession() as session, session.ws_connect(f'{url}stream') as ws:
            await ws.send_json({'set': {'name': 'pause', 'value': True}})
            while True:
                message = json.loads((await asyncio.wait_for(ws.receive(), DEADLINE)).data)
                if 'refused' in message:
                    return message['refused']['reason']

    assert 'nothing offers' in asyncio.run(look())


def test_a_drag_on_the_page_pulls_the_tree(compose, tree_file):
    nodes = compose(solver={'tree': tree_file, 'model': '20'}, viewer=QUIET)
    url, solver = nodes['viewer'].server.url, nodes['solver']

    def is_pulled():
        return np.linalg.norm(solver.simulator.push_load[:3]) > 1.0

    async def drag():
        async with aiohttp.ClientSession() as session, session.ws_connect(f'{url}stream') as ws:
            assert json.loads((await ws.receive()).data)['hello']['can_pull']
            pull = {'segment': 2, 'to': [1.0, 0.0, 1.0], 'stiffness': 5.0}
            end = time.monotonic() + DEADLINE
            while not is_pulled():  # the solver may not have been found yet
                assert time.monotonic() < end
                await ws.send_json({'pull': pull})
                await asyncio.sleep(0.05)
            reset, foot = threading.Event(), {**pull, 'segment': 0}
            solver.simulator.reset = reset.set
            while 0 not in solver.simulator.pushed[0].pushes:
                assert time.monotonic() < end
                await ws.send_json({'pull': foot})
                await ws.send_json({'pull': pull})
                await asyncio.sleep(0.05)
            assert not reset.is_set()  # the tree goes on
            for held in (foot, pull):
                await ws.send_json({'pull': {**held, 'stiffness': 0.0}})
            while is_pulled():
                await asyncio.sleep(0.01)
            assert time.monotonic() < end
            await ws.send_json({'pull': {**pull, 'segment': 99}})
            while 'no segment 99' not in str((await ws.receive()).data):
                assert time.monotonic() < end

    asyncio.run(drag())
    nodes.check()


def test_a_second_system_in_the_domain_is_told_and_not_mixed_in(
    compose, observer, statuses, tree_file
):
    """Both have the same names and topics, and other trees: the page stays with the first."""
    # An executor that waits on a node of it that is destroyed may fail: each system has its own.
    first = compose(solver={'tree': tree_file, 'model': '5'})
    viewer = compose(viewer=QUIET)['viewer']
    with StreamClient(viewer.server.url) as page:
        page.wait(DEADLINE)
        shown = page.description.short_identity
        second = compose(solver={'tree': tree_file, 'model': '3'})

        def is_told():
            status = statuses('viewer: page')
            return status is not None and '2 solvers in this domain: /solver' in status.message

        observer.until(is_told, 'a warning')
        assert 'ROS_DOMAIN_ID' in statuses('viewer: page').message
        observer.until(lambda: viewer._followed.refused > 20, 'refusals')
        page.wait(DEADLINE, frames=page.received + 20)
        assert page.unreadable == 0
        assert page.description.short_identity == shown
        observer.until(lambda: 'which mix' in statuses('solver: output').message, 'both')
        first.check()
        assert not first['solver'].guard.count, first['solver'].guard.latest
        first.close()
        observer.until(lambda: page.description.short_identity != shown, 'the other tree')
        page.wait(DEADLINE, frames=page.received + 5)
        second.check()


def test_states_that_are_not_of_the_tree_are_refused_and_told(compose, tree_file):
    """As of a second system that the graph does not show yet, or of a new model."""
    nodes = compose(solver={'tree': tree_file, 'model': '5'}, viewer=QUIET)
    viewer = nodes['viewer']
    with StreamClient(viewer.server.url) as page:
        page.wait(DEADLINE)
        for numbers, why in (
            ([0.0] * 3, '3 coordinates of a tree with 5'),
            ([np.nan] * 5, 'not finite'),
        ):
            sent = StateWriter(len(numbers)).to_bytes(ModalState(0, np.zeros(3), 0, numbers))
            viewer._receive(deserialize_message(sent, message_class(TREE_STATE)), {})
            (status,) = viewer._refusals.statuses()
            assert status.level == WARN
            assert why in status.message
    assert status.values == {'refused': 2}
    nodes.check()


def test_who_may_set_nothing_may_not_pull(compose):
    nodes = compose(viewer={**QUIET, 'control': False})
    url = nodes['viewer'].server.url

    async def look():
        async with aiohttp.ClientSession() as session, session.ws_connect(f'{url}stream') as ws:
            assert not json.loads((await ws.receive()).data)['hello']['can_pull']
            await ws.send_json({'pull': {'segment': 0, 'to': [0, 0, 0], 'stiffness': 1.0}})
            while 'refused' not in (said := json.loads((await ws.receive()).data)):
                pass
            return said['refused']['reason']

    assert 'can be pulled' in asyncio.run(look())
    assert nodes['viewer'].server.n_refused == 1


def test_a_solver_that_is_active_has_described_its_tree(compose, observer, tree_file):
    nodes = compose(solver={'tree': tree_file})
    assert nodes['solver']._state._scene is not None
    states = observer.listen(TREE_STATE)
    observer.until(lambda: states, 'a state')
    nodes.check()


def n_states(nodes):
    return nodes['solver'].count_subscribers(TREE_STATE.name)


def test_states_are_subscribed_only_while_a_page_is_open(compose, observer, tree_file):
    """And there is one server, with one event loop, for each time that the node is active."""
    made = []
    make = asyncio.new_event_loop
    asyncio.new_event_loop = lambda: made.append(make()) or made[-1]
    try:
        nodes = compose(anemometer={}, wind={}, solver={'tree': tree_file}, viewer=QUIET)
        viewer = nodes['viewer']
        assert len(made) == 1
        url = viewer.server.url

        async def look():
            async with aiohttp.ClientSession() as session, session.ws_connect(f'{url}stream'):
                await asyncio.to_thread(
                    observer.until, lambda: n_states(nodes) == 1, 'a subscription'
                )

        asyncio.new_event_loop = make
        asyncio.run(look())
        observer.until(lambda: n_states(nodes) == 0, 'its end')
        viewer.trigger_deactivate()
        assert all(loop.is_closed() for loop in made)
        viewer.trigger_activate()
        assert viewer.server.url
    finally:
        asyncio.new_event_loop = make


def test_flags_of_the_solver_reach_the_page(compose, observer, tree_file):
    nodes = compose(wind={}, solver={'tree': tree_file}, viewer=QUIET)
    url, flags = nodes['viewer'].server.url, []

    async def look():
        async with aiohttp.ClientSession() as session, session.ws_connect(f'{url}stream') as ws:
            await ws.send_json({'credit': 200})
            while len(flags) < 100 and WIND_LOST | PAUSED not in flags:
                message = await asyncio.wait_for(ws.receive(), DEADLINE)
                if message.type is aiohttp.WSMsgType.BINARY and message.data[:4] != b'TSWD':
                    flags.append(decode_frame(message.data).flags)
                    nodes['solver']._run.is_paused = True

    asyncio.run(look())
    assert flags[0] == WIND_LOST
    assert flags[-1] == WIND_LOST | PAUSED


def test_without_states_no_tree_is_described(compose, observer, tree_file):
    nodes = compose(solver={'tree': tree_file, 'state_rate': 0.0})
    poses = observer.listen(SEGMENT_POSES)
    observer.until(lambda: len(poses) > 30, 'poses')
    assert nodes['solver']._state._scene is None
