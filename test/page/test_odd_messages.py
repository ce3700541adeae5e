# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Messages that no server of ours sends: counted, named, the line made again; in both clients."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
import json
from pathlib import Path
import struct
import threading
import time
from typing import Any

import pytest

pytest.importorskip('aiohttp', reason='aiohttp is not installed')

from aiohttp import web  # noqa: E402

from tree_sway.stream import client as client_module  # noqa: E402
from tree_sway.stream.client import StreamClient  # noqa: E402
from tree_sway.stream.protocol import (  # noqa: E402
    decode_frame,
    encode_frame,
    LARGEST_DESCRIPTION,
)

pytestmark = pytest.mark.usefixtures('little_effort')

DEADLINE = 60.0
STATIC = Path(__file__).parents[2] / 'tree_sway' / 'page' / 'static'
VECTORS = Path(__file__).parent / 'vectors'
DESCRIPTION = (VECTORS / 'description.bin').read_bytes()
FRAME = (VECTORS / 'frame1.bin').read_bytes()


def with_coordinates(count: int) -> bytes:
    """Make a frame of this description with another number of coordinates."""
    return FRAME[:26] + struct.pack('<H', count) + bytes(2 * count)


def with_bytes(whole: bytes, at: int, *values: int) -> bytes:
    """Overwrite some bytes."""
    return whole[:at] + bytes(values) + whole[at + len(values) :]


ODD_MESSAGES: dict[str, str | bytes] = {
    'an open brace': '{',
    'an empty text': '',
    'a list': '[]',
    'a number': '1',
    'null': 'null',
    'a word': '"word"',
    'an empty pong': '{"pong":null}',
    'a pong of letters': '{"pong":"x"}',
    'a pong of 400 digits': '{"pong":' + '9' * 400 + '}',
    'an empty refusal': '{"refused":{}}',
    'a refusal of a number': '{"refused":1}',
    'a status of a number': '{"status":1}',
    'a text of 2 MiB': '{"status":{"a":"' + 'x' * 2**21 + '"}}',
    '200,000 brackets': '[' * 200_000,
    'no bytes': b'',
    'random bytes': bytes(range(200)),
    'a frame of other coordinates': with_coordinates(3),
    'a frame cut short': FRAME[:-1],
    'a frame of another version': with_bytes(FRAME, 1, 9),
    'the begin of a description': b'TSWD',
    'a description changed on its way': with_bytes(DESCRIPTION, len(DESCRIPTION) - 8, 255, 255),
    'a description cut short': DESCRIPTION[:-100],
    'a description of version 9': with_bytes(DESCRIPTION, 4, 9),
    'a header beyond the end': with_bytes(DESCRIPTION, 8, 255, 255, 255, 255),
}


class OddServer:
    """Serves a stream whose first visit brings something odd, every later one the tree."""

    def __init__(self, odd: str | bytes) -> None:
        self._odd, self.visits = odd, 0
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._bound = threading.Event()
        self.port = 0

    def __enter__(self) -> OddServer:
        self._thread.start()
        assert self._bound.wait(DEADLINE)
        return self

    def __exit__(self, *_: object) -> None:
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join(DEADLINE)

    def _run(self) -> None:
        asyncio.set_event_loop(self._loop)
        app = web.Application()
        app.router.add_get('/stream', self._stream)
        runner = web.AppRunner(app, shutdown_timeout=0.0)
        self._loop.run_until_complete(runner.setup())
        site = web.TCPSite(runner, '127.0.0.1', 0)
        self._loop.run_until_complete(site.start())
        self.port = runner.addresses[0][1]
        self._bound.set()
        self._loop.run_forever()
        self._loop.run_until_complete(runner.cleanup())
        self._loop.close()

    async def _stream(self, request: web.Request) -> web.StreamResponse:
        socket = web.WebSocketResponse()
        await socket.prepare(request)
        self.visits += 1
        is_odd = self.visits == 1
        await socket.send_bytes(DESCRIPTION)
        await socket.send_bytes(with_stamp(FRAME, self.visits))
        if is_odd and isinstance(self._odd, str):
            await socket.send_str(self._odd)
        elif is_odd:
            await socket.send_bytes(self._odd)
        async for _ in socket:
            pass
        return socket


def with_stamp(frame: bytes, seconds: int) -> bytes:
    """Give a frame another time [s]."""
    return encode_frame(decode_frame(frame)._replace(stamp=seconds * 10**9))


LARGER_THAN_ALLOWED = {'a message larger than allowed': bytes(LARGEST_DESCRIPTION + 1)}


@pytest.mark.parametrize('name', [*ODD_MESSAGES, *LARGER_THAN_ALLOWED])
def test_an_odd_message_is_counted_named_and_the_line_made_again(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(client_module, '_SHORTEST_WAIT', 0.01)
    odd = {**ODD_MESSAGES, **LARGER_THAN_ALLOWED}[name]
    with (
        OddServer(odd) as server,
        StreamClient(f'http://127.0.0.1:{server.port}/') as client,
    ):
        end = time.monotonic() + DEADLINE
        while client.unreadable == 0 and time.monotonic() < end:
            time.sleep(0.005)
        client.wait(DEADLINE, frames=2)
        assert 'cannot be read' in client.problem
        assert client.state == 'open'
        assert client.unreadable == 1
        assert server.visits == 2


def test_javascript_counts_names_and_connects_again(javascript: Callable[..., Any]) -> None:
    # A page cannot find a digest at once; it checks the numbers.
    seen = {name: odd for name, odd in ODD_MESSAGES.items() if 'changed' not in name}
    odd = [
        {'text': each} if isinstance(each, str) else {'bytes': list(each)}
        for each in seen.values()
    ]
    given = {'odd': odd, 'tree': list(DESCRIPTION), 'frame': list(FRAME)}
    program = f"""
      import {{ mock }} from "node:test";
      import {{ TreeStream }} from "{(STATIC / 'client.js').as_uri()}";
      mock.timers.enable({{ apis: ["setTimeout", "setInterval"] }});
      globalThis.WebSocket = class {{
        static OPEN = 1;
        static all = [];
        constructor() {{ WebSocket.all.push(this); this.readyState = 1; }}
        send() {{}}
        close() {{ this.readyState = 3; this.onclose?.(); }}
      }};
      let text = "";
      for await (const chunk of process.stdin) text += chunk;
      const {{ odd, tree, frame }} = JSON.parse(text);
      const bytes = (list) => Uint8Array.from(list).buffer;
      const answers = odd.map((each) => {{
        WebSocket.all.length = 0;
        let problem = "", frames = 0, lost = 0;
        const stream = new TreeStream("http://127.0.0.1:9/", {{
          onMessage: (message) => (problem = message.unreadable ?? problem),
          onState: (state) => (lost += state === "lost"),
          onFrame: () => (frames += 1),
        }});
        stream.open();
        for (let visit = 0; visit < 2; visit++) {{
          const socket = WebSocket.all[visit];
          socket.onopen();
          socket.onmessage({{ data: bytes(tree) }});
          socket.onmessage({{ data: bytes(frame) }});
          if (!visit) socket.onmessage({{ data: each.text ?? bytes(each.bytes) }});
          if (!visit) socket.onmessage({{ data: bytes(frame) }}); // on its way when it was closed
          mock.timers.tick(700);
        }}
        stream.close();
        return [stream.connection.unreadable, lost, frames, WebSocket.all.length, problem];
      }});
      console.log(JSON.stringify(answers));
    """
    for name, answer in zip(seen, javascript(program, json.dumps(given)), strict=True):
        assert answer[:4] == [1, 1, 2, 2], (name, answer)
        assert answer[4], name
