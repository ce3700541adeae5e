# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Two sites in two processes on one line of Zenoh: how far apart their tips are."""

from __future__ import annotations

from pathlib import Path
import signal
import socket
import subprocess
import sys

import numpy as np
import pytest

from tree_sway.core.arrays import Floats

pytest.importorskip('zenoh', reason='eclipse-zenoh is not installed')

ROOT = Path(__file__).resolve().parents[2]
SECONDS = 8.0
SEEDLING = str(ROOT / 'test' / 'files' / 'data' / 'seedling.yaml')
TALL = ('--option', 'length_unit=3')


def free_port() -> int:
    with socket.socket() as trial:
        trial.bind(('127.0.0.1', 0))
        return int(trial.getsockname()[1])


def relay(role: str, output: Path, *given: str) -> subprocess.Popen[str]:
    command = [sys.executable, '-m', 'tree_sway.commands.cli', 'relay', role, SEEDLING]
    return subprocess.Popen(
        [*command, *TALL, '-o', str(output), *given],
        cwd=ROOT, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
    )  # fmt: skip


def apart(one: Path, other: Path) -> tuple[Floats, Floats]:
    """Time since the other began [s], and how far its tip is from that of the first [m]."""
    rows = [
        {int(line.split(',')[0]): line.split(',')[1:] for line in path.read_text().split()[1:]}
        for path in (one, other)
    ]
    stamps = sorted(set(rows[0]) & set(rows[1]))
    tips = [np.array([rows[k][stamp] for stamp in stamps], dtype=float) for k in (0, 1)]
    assert np.ptp(tips[0][:, 0]) > 0.005  # it sways
    return 1e-9 * (np.array(stamps) - stamps[0]), np.linalg.norm(tips[0] - tips[1], axis=1)


@pytest.fixture(scope='module')
def sites(tmp_path_factory: pytest.TempPathFactory) -> dict[str, tuple[Floats, Floats]]:
    """Distances of sites from the one that sends: all join while it sends."""
    folder = tmp_path_factory.mktemp('sites')
    place = f'tcp/127.0.0.1:{free_port()}'
    seconds = ['--seconds', str(SECONDS)]
    sender = relay('send', folder / 'sender', '--listen', place, '--wind', 'canopy')
    assert sender.stdout is not None
    assert 'sending' in sender.stdout.readline()
    kinds: dict[str, list[str]] = {'snapshot': []}
    others = {
        kind: relay('receive', folder / kind, '--connect', place, *seconds, *given)
        for kind, given in kinds.items()
    }
    try:
        for process in others.values():
            _, errors = process.communicate(timeout=240)
            assert process.returncode == 0, errors
        sender.send_signal(signal.SIGINT)  # it has sent for as long as they took to come
        _, errors = sender.communicate(timeout=20)
        assert sender.returncode == 0, errors
    finally:
        for process in (sender, *others.values()):
            process.kill()
    return {kind: apart(folder / 'sender', folder / kind) for kind in kinds}


def test_by_a_snapshot_tips_agree_at_once(sites: dict[str, tuple[Floats, Floats]]) -> None:
    time, distance = sites['snapshot']
    print(f'snapshot: most {1e3 * distance.max():.3f} mm')
    assert time[-1] > 0.8 * SECONDS
    assert distance.max() <= 1e-3
