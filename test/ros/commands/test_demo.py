# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The demo as a user starts it: a process of its own, over real DDS, to its end."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
import re
import signal
import subprocess
import sys
import threading

import pytest

from tree_sway.files.commands.arguments import opened_scene
from tree_sway.files.trees.source import open_tree

pytest.importorskip('rclpy', reason='ROS 2 is not installed')
from tree_sway_ros.commands import demo  # noqa: E402, I100

pytestmark = pytest.mark.ros

DEADLINE = 180.0  # the first start compiles
ROOT = Path(__file__).resolve().parents[3]
SONIC = ROOT / '..' / 'shared' / 'data' / 'wind' / 'sonic_20hz_1245.toa5.dat'


Started = subprocess.Popen[str]
_started: list[Started] = []


@pytest.fixture
def environment(ros_environment: dict[str, str]) -> Iterator[dict[str, str]]:
    """Give a ROS domain for one test alone, on this machine alone; no process outlives it."""
    yield ros_environment
    while _started:
        process = _started.pop()
        process.kill()
        process.wait()


def start(environment: dict[str, str], *arguments: str) -> Started:
    """Start a command; standard output is no terminal there."""
    command = [sys.executable, '-m', 'tree_sway', *arguments]
    pipe = subprocess.PIPE
    _started.append(
        subprocess.Popen(command, env=environment, stdout=pipe, stderr=pipe, text=True, cwd=ROOT)
    )
    return _started[-1]


def lines_until(process: Started, sign: str) -> Iterator[str]:
    """Lines of a process up to one that holds a sign; the process is killed at the deadline."""
    assert process.stdout is not None
    timer = threading.Timer(DEADLINE, process.kill)
    timer.start()
    for line in process.stdout:
        yield line
        if sign in line:
            break
    timer.cancel()


def number(pattern: str, text: str) -> float:
    """Return the number that a pattern finds in a text."""
    found = re.search(pattern, text)
    assert found, text
    return float(found[1])


def test_it_runs_for_the_seconds_it_was_given(environment: dict[str, str]) -> None:
    process = start(environment, 'demo', 'goldcrest', '--seconds', '3')
    out, err = process.communicate(timeout=DEADLINE)
    assert process.returncode == 0, err
    assert out.startswith('goldcrest: ')
    assert '| poses ' in out
    assert '\r' not in out
    assert number(r'poses +(\d+) at', out) > 90
    assert number(r'mean (\+\d+\.\d) east', out) > 0.0  # a westerly bends it to the east


def test_a_record_shorter_than_what_was_asked_is_said(
    environment: dict[str, str], tmp_path: Path
) -> None:
    wind = tmp_path / 'wind.csv'
    rows = ''.join(f'{0.1 * k:.1f},3.0,0.0\n' for k in range(11))
    wind.write_text(f'time,u [m/s],v [m/s]\n{rows}')
    process = start(environment, 'demo', 'goldcrest', '--wind', str(wind), '--seconds', '3')
    _, err = process.communicate(timeout=DEADLINE)
    assert process.returncode == 0, err
    assert 'note: the wind has 1 s of the 3 s that were asked for' in err


@pytest.mark.long
@pytest.mark.skipif(not SONIC.exists(), reason=f'needs the record {SONIC}')
def test_a_second_process_receives_every_pose_of_a_recorded_wind(
    environment: dict[str, str],
) -> None:
    demo = start(environment, 'demo', '--wind', str(SONIC), '--seconds', '30')
    assert any('| poses ' in line for line in lines_until(demo, '| poses '))
    listener = start(environment, 'listen', '--seconds', '10')
    heard, err = listener.communicate(timeout=DEADLINE)
    assert listener.returncode == 0, err
    said, err = demo.communicate(timeout=DEADLINE)
    assert demo.returncode == 0, err
    for text in (heard, said):
        assert number(r'poses +\d+ at ([\d.]+) Hz', text) == pytest.approx(60.0, rel=0.01)
    # Frames that a solver on a busy machine has left out are missing in both.
    heard_gaps, own_gaps = (
        number(r' (\d+) missing', text.replace('none missing', '0 missing'))
        for text in (heard, said)
    )
    assert heard_gaps <= own_gaps
    assert number(r'tip +([\d.]+) mm from rest on average', said) > 0.5


@pytest.mark.parametrize(
    'signals',
    [
        pytest.param([signal.SIGINT], marks=pytest.mark.long),
        [signal.SIGINT] * 5,
        pytest.param([signal.SIGTERM], marks=pytest.mark.long),
    ],
)
def test_ctrl_c_ends_it_with_a_summary(
    environment: dict[str, str], signals: list[signal.Signals]
) -> None:
    """And while it runs, a second one in its domain is refused."""
    process = start(environment, 'demo', 'goldcrest')
    assert any('| poses ' in line for line in lines_until(process, '| poses '))
    if len(signals) > 1:
        second = start(environment, 'demo', 'goldcrest', '--seconds', '1')
        _, err = second.communicate(timeout=DEADLINE)
        assert second.returncode == 2
        assert 'a different program publishes' in err
    for one in signals:
        process.send_signal(one)
    out, err = process.communicate(timeout=DEADLINE)
    assert process.returncode == 0, err
    assert re.search(r'^poses +\d+ at', out, re.MULTILINE)


@pytest.mark.parametrize(
    ('arguments', 'variables', 'expected'),
    [
        (['sapling'], {}, "no tree 'sapling'; give a file, or one of"),
        (['--wind', '/no/such.csv'], {}, '/no/such.csv: no such file'),
        (['--rate', '0'], {}, "parameter 'rate': 0 is out of range; give 2 .. 1000"),
        ([], {'ROS_DOMAIN_ID': '900'}, 'ROS_DOMAIN_ID=900'),
    ],
)
def test_what_cannot_start_says_why(
    environment: dict[str, str], arguments: list[str], variables: dict[str, str], expected: str
) -> None:
    process = start({**environment, **variables}, 'demo', *arguments, '--seconds', '1')
    _, err = process.communicate(timeout=DEADLINE)
    assert process.returncode == 2
    (line,) = [line for line in err.splitlines() if not line.startswith('[INFO]')]
    assert line.startswith('tree-sway demo: ')
    assert expected in line


def test_the_solver_gets_the_tree_with_the_wood_that_is_said() -> None:
    parser = argparse.ArgumentParser()
    demo.add_arguments(parser)
    said = parser.parse_args(['goldcrest', '--density', '700'])
    scene = opened_scene(said)
    plain = parser.parse_args(['goldcrest', '--species', 'spruce'])
    with ExitStack() as files:
        path = demo._tree_of(scene, said, files)
        assert open_tree(path).species.density == 700.0
        assert demo._tree_of(opened_scene(plain), plain, files) == 'goldcrest'
    assert not Path(path).exists()
    assert demo._nodes(said, path)['solver']['tree'] == path
    assert demo._nodes(plain, 'goldcrest')['solver']['species'] == 'spruce'


def test_the_player_learns_how_to_read_a_bag_and_where_to_begin() -> None:
    parser = argparse.ArgumentParser()
    demo.add_arguments(parser)
    words = 'goldcrest --wind bag --wind-option topic=/mast/wind --wind-option yaw=1.57 --start 30'
    player = demo._nodes(parser.parse_args(words.split()), 'goldcrest')['player']
    parameters = {'file': 'bag', 'reader_options': 'topic=/mast/wind yaw=1.57', 'start': 30.0}
    assert player == parameters
