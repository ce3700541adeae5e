# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``--sensor`` of show, simulate and record as a user types it, without ROS."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
import csv
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
import json
from pathlib import Path
import re
import signal
import socket
import subprocess
import sys
import threading
import time
from typing import Any

import pytest

aiohttp = pytest.importorskip('aiohttp', reason='aiohttp is not installed')

from tree_sway.commands.cli import main  # noqa: E402
from tree_sway.files.wind.wind_file import read_wind  # noqa: E402
from tree_sway.live.commands import sensor_arguments  # noqa: E402
from tree_sway.live.commands.sensor_arguments import HELP  # noqa: E402
from tree_sway.live.registry import SOURCE_KINDS  # noqa: E402
from tree_sway.stream.protocol import decode_frame  # noqa: E402

ROOT = Path(__file__).resolve().parents[3]
SEEDLING = str(ROOT / 'test' / 'files' / 'data' / 'seedling.yaml')
DEADLINE = 120.0


class Instrument:
    """Lines that are sent to a port of this machine, twenty times a second."""

    def __init__(self, line: str) -> None:
        self.line = line
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
            probe.bind(('127.0.0.1', 0))
            self.port = int(probe.getsockname()[1])
        self.address = f'udp://127.0.0.1:{self.port}'
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._send, daemon=True)
        self._thread.start()

    def close(self) -> None:
        self._over.set()
        self._thread.join()

    def _send(self) -> None:
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
            while not self._over.wait(0.05):
                sender.sendto(self.line.encode(), ('127.0.0.1', self.port))


@pytest.fixture
def instrument() -> Iterator[Instrument]:
    made = Instrument('$WIMWV,270.0,R,6.4,M,A\r\n')
    yield made
    made.close()


@pytest.fixture
def no_ros(monkeypatch: pytest.MonkeyPatch) -> None:
    for module in ('rclpy', 'rosbags'):
        monkeypatch.setitem(sys.modules, module, None)


def test_the_help_names_every_kind_of_source() -> None:
    for kind in SOURCE_KINDS:
        assert kind['schemes'].split()[0] in HELP


def test_a_tree_is_simulated_in_live_wind(
    instrument: Instrument, tmp_path: Path, no_ros: None, capfd: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / 'sway.csv'
    arguments = ['--sensor', instrument.address, '--seconds', '2', '-o', str(out)]
    assert main(['simulate', SEEDLING, *arguments]) == 0
    assert 'sensor: wind comes: 6.4 m/s from W (MWV R)' in capfd.readouterr().err
    with out.open() as file:
        rows = list(csv.DictReader(file))
    tips = [float(row[next(name for name in row if 'tip_x' in name)]) for row in rows]
    assert max(tips) > 1e-4


def test_live_wind_is_recorded_as_a_table_that_is_read_again(
    instrument: Instrument, tmp_path: Path, no_ros: None, capfd: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / 'wind.csv'
    line = ['record', '--sensor', instrument.address, '-o', str(out), '--seconds', '1.5']
    assert main(line) == 0
    said = capfd.readouterr()
    assert 'samples of udp://' in said.out
    record = read_wind(out)
    is_short = record.duration < 1.4
    assert ('note: wind.csv has' in said.err) or not is_short
    assert len(record.time) > 10
    assert record.velocity[:, 0] == pytest.approx(6.4)
    assert record.epoch is not None
    assert abs(record.epoch - time.time()) < DEADLINE
    assert main(line) == 2
    assert 'exists' in capfd.readouterr().err


def test_a_table_without_a_source_is_no_bag(
    tmp_path: Path, no_ros: None, capfd: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / 'wind.csv'
    assert main(['record', '-o', str(out)]) == 2
    assert 'a table, and no wind for it; add --sensor SOURCE' in capfd.readouterr().err
    assert not out.exists()


def test_means_are_recorded_with_their_gusts(tmp_path: Path, no_ros: None) -> None:
    served = []

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            served.append(self.path)
            minute = time.strftime('%Y-%m-%dT%H:%M', time.gmtime(900.0 * len(served)))
            wind = {'wind_speed_10m': 6.0, 'wind_direction_10m': 180, 'wind_gusts_10m': 11.0}
            current = {'time': minute, 'interval': 900, **wind}
            self.send_response(200)
            self.end_headers()
            units = {'wind_speed_10m': 'm/s'}
            self.wfile.write(json.dumps({'current_units': units, 'current': current}).encode())

        def log_message(self, *_: Any) -> None:
            """Stay silent."""

    server = ThreadingHTTPServer(('127.0.0.1', 0), Handler)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    out = tmp_path / 'means.csv'
    address = f'open-meteo:52.5,13.4?every=0.2&server=http://127.0.0.1:{server.server_port}/'
    assert main(['record', '--sensor', address, '-o', str(out), '--seconds', '2']) == 0
    server.shutdown()
    server.server_close()
    lines = out.read_text().splitlines()
    assert lines[0] == 'time,wind_speed [m/s],wind_direction [deg],wind_gust [m/s]'
    assert lines[1].endswith('6.000,180.0,11.000')
    record = read_wind(out)
    assert any('by their gusts' in note for note in record.notes)
    assert record.velocity[:, 1].mean() == pytest.approx(6.0, rel=0.1)


def test_a_source_that_is_not_reached_is_told_at_once_and_given_up_soon(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A machine without a network, or a server that is gone."""
    monkeypatch.setattr(sensor_arguments, '_UNREACHED', 1.0)
    server = 'http://127.0.0.1:1/v1'
    address = f'open-meteo:52.5,13.4?server={server}'
    began = time.monotonic()
    assert main(['simulate', SEEDLING, '--sensor', address, '-o', str(tmp_path / 'a.csv')]) == 2
    assert time.monotonic() - began < sensor_arguments._PATIENCE
    said = capfd.readouterr().err
    assert f'sensor: waiting for {server}; Ctrl-C ends it\n' in said
    last = said.splitlines()[-1]
    assert f'no wind within 1 s: no connection to {server}: refused' in last


@pytest.mark.parametrize(
    ('arguments', 'expected'),
    [
        (['simulate', SEEDLING, '--sensor', 'x', '-o', '{}/a.csv'], 'is no source of wind'),
        (['show', SEEDLING, '--sensor', 'mqqt://a/b'], "did you mean 'mqtt'"),
        (['show', SEEDLING, '--sensor', 'tempest', '--wind', 'canopy'], 'give one of the two'),
        (['record', '--sensor', 'tempest', '-o', '{}/bag'], 'name it wind.csv'),
        (['record', '--sensor', 'udp://127.0.0.1:1', '-o', '{}/a.csv', '--seconds', '1'], 'udp'),
        (['record', '-o', '{}/bag'], "No module named 'rclpy'"),
    ],
)
def test_what_cannot_be_listened_to_is_refused_in_words(
    arguments: list[str], expected: str, tmp_path: Path, no_ros: None,
    capfd: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    assert main([each.format(tmp_path) for each in arguments]) == 2
    assert expected in capfd.readouterr().err
    assert not list(tmp_path.iterdir())


def start(address: str) -> subprocess.Popen[str]:
    command = [sys.executable, '-m', 'tree_sway', 'show', SEEDLING]
    command += ['--port', '0', '--sensor', address]
    pipe = subprocess.PIPE
    return subprocess.Popen(command, stdout=pipe, stderr=pipe, text=True, cwd=ROOT)


def test_the_page_shows_the_live_wind_and_ends_at_once() -> None:
    instrument = Instrument('$WIMWV,270.0,R,6.4,M,A\r\n')
    process = start(f'{instrument.address}?name=Mast')
    timer = threading.Timer(DEADLINE, process.kill)
    timer.start()
    try:
        assert process.stdout is not None
        url = next(found[1] for line in process.stdout if (found := re.search(r'(http\S+)', line)))

        async def look() -> dict[str, Any]:
            async with (
                aiohttp.ClientSession() as session,
                session.ws_connect(f'{url}stream') as ws,
            ):
                await ws.send_json({'credit': 4000})
                states, wind = set(), dict[str, Any]()
                while len(states) < 10 or wind.get('state') != 'live':
                    message = await asyncio.wait_for(ws.receive(), DEADLINE)
                    if message.type is aiohttp.WSMsgType.TEXT:
                        wind = json.loads(message.data).get('status', {}).get('wind', wind)
                    elif message.data[:4] not in (b'TSWD', b'TSWT'):
                        states.add(decode_frame(message.data).coordinates.tobytes())
                return wind

        wind = asyncio.run(look())
        assert (wind['kind'], wind['speed']) == ('live', 6.4)
        assert wind['name'].startswith('Mast, udp://')
        assert wind['wind'] == pytest.approx([6.4, 0.0], abs=1e-3)
        begin = time.monotonic()
        process.send_signal(signal.SIGINT)
        assert process.wait(DEADLINE) == 0
        assert time.monotonic() - begin < 5.0
    finally:
        instrument.close()
        timer.cancel()
        process.kill()
        process.communicate()


def test_lines_that_nobody_understands_are_told_in_the_terminal() -> None:
    instrument = Instrument('{"serial": "AB-1", "temperature": 21.5}')
    process = start(instrument.address)
    timer = threading.Timer(DEADLINE, process.kill)
    timer.start()
    try:
        assert process.stderr is not None
        heard = next(line for line in process.stderr if 'listening' in line)
        begin = time.monotonic()
        told = next(line for line in process.stderr if 'came' in line)
        assert time.monotonic() - begin < 5.0
        assert heard.startswith('sensor: listening to udp://')
        assert 'none was understood, the last: {"serial": "AB-1", "temperature": 21.5}' in told
    finally:
        instrument.close()
        timer.cancel()
        process.kill()
        process.communicate()
