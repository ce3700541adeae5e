# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The soak, short: the chain through all faults, and the figures at its end."""

from __future__ import annotations

import math
from pathlib import Path
import re
import subprocess
import sys

import pytest
from tree_sway_lab.soak.health import growth, Health, health

ROOT = Path(__file__).resolve().parents[3]


def test_growth_is_the_slope_after_the_warm_up() -> None:
    steady = [Health(float(k), 100.0 + (k < 10) * 50.0, 9, 9) for k in range(60)]
    assert growth(steady) == pytest.approx((0.0, 0.0), abs=1e-6)
    leaking = [Health(36.0 * k, 100.0 + 0.02 * k, 9, 9) for k in range(101)]
    assert growth(leaking) == pytest.approx((2.0, 0.0))
    shaking = [Health(36.0 * k, 100.0 + 0.5 * (-1) ** k, 9, 9) for k in range(101)]
    slope, error = growth(shaking)
    assert abs(slope) < 2.0 * error < 0.5
    assert math.isnan(growth([])[0])


@pytest.mark.skipif(not sys.platform.startswith('linux'), reason='reads /proc')
def test_a_process_looks_at_itself() -> None:
    now = health(3.0)
    assert now.time == 3.0
    assert now.memory > 10.0
    assert now.handles > 2
    assert now.threads >= 1


@pytest.mark.long
@pytest.mark.skipif(not sys.platform.startswith('linux'), reason='reads /proc')
@pytest.mark.parametrize(
    ('command', 'told'),
    [
        (['soak', '--page', '--hours', '0.001', '--slope', '1e9'], r'^slowest  of 4 clients: '),
        (['fuzz', '--minutes', '0.03', '--only', 'Modbus TCP'], r'^Modbus TCP +\d+ messages'),
    ],
    ids=['soak', 'fuzz'],
)
def test_a_page_and_a_reader_are_tried_without_ros(command: list[str], told: str) -> None:
    whole = [sys.executable, '-m', 'tree_sway', 'lab', *command]
    ended = subprocess.run(whole, capture_output=True, text=True, cwd=ROOT, timeout=240.0)
    assert ended.returncode == 0, ended.stdout + ended.stderr
    assert re.search(told, ended.stdout, re.MULTILINE)


@pytest.mark.long
@pytest.mark.ros
@pytest.mark.skipif(not sys.platform.startswith('linux'), reason='reads /proc')
@pytest.mark.parametrize('kind', ['nodes', 'demo'])
def test_the_chain_goes_through_all_faults(kind: str, ros_environment: dict[str, str]) -> None:
    command = [sys.executable, '-m', 'tree_sway', 'lab', 'soak', '--hours', '0.003']
    ended = subprocess.run(
        [*command, '--every', '0.5', '--rate', '2', '--slope', '1e9']
        + ['--demo'] * (kind == 'demo'),
        env=ros_environment,
        capture_output=True,
        text=True,
        cwd=ROOT,
        timeout=240.0,
    )
    assert ended.returncode == 0, ended.stderr
    assert re.search(r'^poses +\d+ at', ended.stdout, re.MULTILINE)
    assert '(wanted 120)' in ended.stdout
    of_each = {'nodes': ['anemometer', 'wind', 'solver', 'viewer'], 'demo': ['demo']}[kind]
    assert re.findall(r'^memory +(\w+)', ended.stdout, re.MULTILINE) == of_each
    assert 'failed   0 callbacks; 0 restarts' in ended.stdout
