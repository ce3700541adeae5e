# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A phone that measures while it is asked: a recorded stream, as phyphox's remote access gives."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, HTTPServer
import json
from pathlib import Path
import threading
from urllib.parse import parse_qsl, urlsplit

import numpy as np
import pytest

from tree_sway.commands import cli
from tree_sway.errors import FormatError, TransportError
from tree_sway.files.wind.phone import read_phone_sway
from tree_sway.identification.commands import calibrate
from tree_sway.identification.measured_sway import estimate_sway

ROOT = Path(__file__).parents[3]
DATA = ROOT / 'examples' / 'data'
RECORDED = np.loadtxt(DATA / 'pull.phyphox.csv', delimiter=',', skiprows=1)[:, :4]
NAMES = ('acc_time', 'accX', 'accY', 'accZ')


def answer_of(rows: np.ndarray) -> str:
    """Answer of the app when these rows are measured, all buffers asked for in full."""
    buffers = {
        name: {'size': 0, 'updateMode': 'full', 'buffer': column.tolist()}
        for name, column in zip(NAMES, rows.T, strict=True)
    }
    status = {'session': 'c0ffee', 'measuring': True, 'timedRun': False, 'countDown': 0}
    return json.dumps({'buffer': buffers, 'status': status})


@contextmanager
def phone(answers: list[str]) -> Iterator[str]:
    """Serve answers, one after the other and then the last of them; yield the address."""
    asked = []

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            asked.append(urlsplit(self.path))
            body = answers[min(len(asked), len(answers)) - 1].encode()
            self.send_response(200)
            self.end_headers()
            self.wfile.write(body)

        def log_message(self, *_: object) -> None:
            pass

    with HTTPServer(('127.0.0.1', 0), Handler) as server:
        thread = threading.Thread(target=server.serve_forever, args=(0.01,))
        thread.start()
        try:
            yield f'http://127.0.0.1:{server.server_port}'
        finally:
            server.shutdown()
            thread.join()
    assert all(each.path == '/get' for each in asked)
    assert all(dict(parse_qsl(each.query)) == dict.fromkeys(NAMES, 'full') for each in asked)


def test_what_it_has_measured_gives_the_frequency() -> None:
    with phone([answer_of(RECORDED)]) as address:
        record = read_phone_sway(f'{address}/')
    np.testing.assert_allclose(record.motion, RECORDED[:, 1:])
    np.testing.assert_allclose(record.time - record.time[0], RECORDED[:, 0] - RECORDED[0, 0])
    assert record.quantity == 'acceleration'
    found = estimate_sway(record.time, record.motion)
    assert found.frequency == pytest.approx(0.45, rel=0.01)


def test_a_tree_is_fitted_as_soon_as_it_has_measured_for_the_time(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(calibrate, '_PERIOD', 0.01)
    lengths = [int(np.searchsorted(RECORDED[:, 0], end)) for end in (2.0, 9.0, 30.0, 60.0)]
    tree, fitted = DATA / 'forest_tree.treeqsm.txt', tmp_path / 'fitted.yaml'
    with phone([answer_of(RECORDED[:length]) for length in lengths]) as address:
        words = ['calibrate', str(tree), '--record', address, '--seconds', '25']
        assert cli.main([*words, '--leaves', 'off', '-o', str(fitted)]) == 0
    said = capsys.readouterr().out
    assert f'{address}: acceleration of ax, ay, az, 10 swings after the release' in said
    assert '-> 0.45' in said
    assert fitted.is_file()


def test_one_that_has_stopped_is_not_waited_for(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(calibrate, '_PERIOD', 0.01)
    with phone([answer_of(RECORDED[:100])]) as address:
        words = ['calibrate', 'goldcrest', '--record', address, '--seconds', '3600']
        assert cli.main([*words, '-o', str(tmp_path / 'fitted.yaml')]) == 2
    assert 'the measurement has stopped; start the experiment' in capsys.readouterr().err


NO_ACCELERATIONS = 'no accelerations in the answer; open phyphox'


HOLE = np.where(np.arange(100)[:, None] == 5, [0.0, np.nan, 0.0, 0.0], 0.0) + RECORDED[:100]
ODD = {
    'a printer': ('<html>ready</html>', NO_ACCELERATIONS),
    'a list': ('[]', NO_ACCELERATIONS),
    'light': ('{"buffer": {"illum": {"buffer": [1.0]}}}', NO_ACCELERATIONS),
    'a number for numbers': (
        answer_of(RECORDED[:9]).replace('"buffer": [', '"buffer": 3, "was": ['),
        NO_ACCELERATIONS,
    ),
    'nothing yet': (answer_of(RECORDED[:0]), 'nothing is measured yet; start the experiment'),
    'a hole': (answer_of(HOLE).replace('NaN', 'null'), "'None'"),
    'no number': (answer_of(HOLE), "'nan'"),
    'backwards': (answer_of(RECORDED[:9][::-1]), 'does not come after'),
}


@pytest.mark.parametrize('name', ODD)
def test_an_answer_that_is_no_motion_is_refused_with_the_cure(name: str) -> None:
    answer, said = ODD[name]
    with phone([answer]) as address, pytest.raises(FormatError, match=said) as caught:
        read_phone_sway(address)
    assert address in str(caught.value)


def test_where_no_phone_is_the_cure_is_said() -> None:
    with phone(['']) as address:
        pass
    with pytest.raises(TransportError, match='allow remote access in phyphox'):
        read_phone_sway(address)
