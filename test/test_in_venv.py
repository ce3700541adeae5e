# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The one-command set-up: what it refuses, what it leaves out, when it does its work again."""

from __future__ import annotations

import importlib.util
import os
from pathlib import Path
import re
import sys
from types import ModuleType

import pytest

ROOT = Path(__file__).resolve().parent.parent
SCRIPT = ROOT / '.ci' / 'in_venv.py'


@pytest.fixture
def script(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    """Load the script as a module, its environment in a folder of the test."""
    monkeypatch.setenv('TREE_SWAY_VENV', str(tmp_path / 'venv'))
    spec = importlib.util.spec_from_file_location('in_venv', SCRIPT)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def refusal(capsys: pytest.CaptureFixture[str]) -> str:
    """Return the one line on standard error."""
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith('in_venv: ')
    return line


def test_no_command(script: ModuleType, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit, match='2'):
        script.main([])
    assert 'no command given' in refusal(capsys)


@pytest.mark.parametrize(
    ('version', 'command', 'expected'),
    [
        ((3, 9, 18), 'show', 'is too old, 3.10 is the least; run it with'),
        ((3, 15, 0), 'demo', 'are for Python 3.10 to 3.14, not '),
        ((3, 14, 0), 'demo', ''),
        ((3, 15, 0), 'show', ''),
    ],
)
def test_a_python_without_wheels(
    script: ModuleType,
    version: tuple[int, int, int],
    command: str,
    expected: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr(sys, 'version_info', version)
    monkeypatch.setattr(script.platform, 'machine', lambda: 'x86_64')
    if not expected:
        assert script.extras_for(['tree-sway', command])
        return
    with pytest.raises(SystemExit, match='2'):
        script.extras_for(['tree-sway', command])
    assert expected in refusal(capsys)


@pytest.mark.parametrize(
    ('words', 'extra'),
    [
        ('tree-sway demo --sensor serial:/dev/ttyUSB0:4800', 'sensors'),
        ('tree-sway study oaks.yaml -o oaks.parquet', 'parquet'),
        ('tree-sway render oak.yaml -o oak.mp4', 'film'),
    ],
)
def test_what_a_command_line_names_brings_its_extra(
    script: ModuleType, words: str, extra: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(script, 'check_machine', lambda with_ros: None)
    assert extra in script.extras_for(words.split())


def test_a_machine_without_wheels(
    script: ModuleType, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(script.platform, 'machine', lambda: 'aarch64')
    assert 'ros' not in script.extras_for(['tree-sway', 'show', 'oak.yaml'])
    assert 'ros' not in script.extras_for(['pytest'])
    with pytest.raises(SystemExit, match='2'):
        script.extras_for(['tree-sway', 'demo'])
    assert 'x86_64 Linux, not aarch64' in refusal(capsys)


@pytest.mark.parametrize(
    ('command', 'brought', 'left'),
    [
        ('tree-sway demo --seconds 10', {'plot', 'ros'}, {'film', 'lab', 'test', 'lint'}),
        ('tree-sway --version', {'progress', 'plot', 'study', 'bag'}, {'ros'}),
        ('tree-sway info scan.mat', {'bag'}, {'ros', 'film'}),
        ('tree-sway demo --wind=gale.mcap', {'ros', 'bag'}, {'film'}),
        ('tree-sway lab compare', {'lab'}, {'film', 'test'}),
        ('solver --ros-args', {'ros'}, {'film'}),
        ('pytest -n 4', {'ros', 'bag', 'plot', 'lab', 'test'}, {'lint'}),
        ('mypy', {'lint'}, {'ros', 'lab'}),
        (f'python {"x" * 300}', {'bag'}, {'ros'}),
    ],
)
def test_a_command_brings_what_it_needs_and_no_more(
    script: ModuleType,
    command: str,
    brought: set[str],
    left: set[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(script.platform, 'machine', lambda: 'x86_64')
    extras = script.extras_for(command.split())
    assert brought <= extras
    assert not left & extras


def test_what_later_commands_need_is_brought_with_the_first(
    script: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[set[str]] = []
    ran: list[list[str]] = []
    monkeypatch.setattr(script, 'make_ready', lambda environment, extras: asked.append(extras))
    monkeypatch.setattr(script.os, 'execve', lambda program, words, environment: ran.append(words))
    for words in (['--with', 'lint,wasm', sys.executable, '-V'], [sys.executable, '-V']):
        script.main(words)
    assert asked[0] - asked[1] == {'lint', 'wasm'}
    assert ran[0] == ran[1]
    assert ran[0][1:] == ['-V']


def test_every_extra_that_is_asked_for_is_one_of_setup_py(script: ModuleType) -> None:
    asked = {*script.ALWAYS, *script.NEEDS_OF_FILES.values(), *sum(script.NEEDS.values(), ())}
    assert len(asked) > 3
    setup = (ROOT / 'setup.py').read_text()
    of_setup = asked - {'lab'}  # a project of its own
    assert not [extra for extra in of_setup if f"'{extra}': [" not in setup]


def test_a_python_without_ensurepip(
    script: ModuleType, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, 'ensurepip', None)
    with pytest.raises(SystemExit, match='2'):
        script.make_venv({})
    assert 'sudo apt install python3-venv' in refusal(capsys)


def test_a_sourced_ros_is_left_aside(
    script: ModuleType, capsys: pytest.CaptureFixture[str]
) -> None:
    sourced = {
        'ROS_DISTRO': 'jazzy',
        'AMENT_PREFIX_PATH': '/opt/ros/jazzy',
        'PYTHONPATH': '/opt/ros/jazzy/lib/python3.12/site-packages',
        'LD_LIBRARY_PATH': '/opt/ros/jazzy/lib',
        'PATH': '/opt/ros/jazzy/bin:/usr/bin',
        'ROS_DOMAIN_ID': '7',
        'HOME': '/home/me',
    }
    kept = script.without_ros(sourced)
    assert kept == {'PATH': '/usr/bin', 'ROS_DOMAIN_ID': '7', 'HOME': '/home/me'}
    assert 'leaving the sourced jazzy aside' in refusal(capsys)


def test_a_shell_without_ros_is_left_alone(
    script: ModuleType, capsys: pytest.CaptureFixture[str]
) -> None:
    plain = {'PATH': '/usr/bin', 'PYTHONPATH': '/mine', 'LD_LIBRARY_PATH': '/mine'}
    assert script.without_ros(plain) == plain
    assert capsys.readouterr().err == ''


@pytest.mark.parametrize(
    ('words', 'expected'),
    [
        ("WARNING: ... NewConnectionError('<pip._vendor...", 'no network'),
        ('ERROR: ... [Errno 28] No space left on device', 'the disk is full'),
        ('so it goes\nERROR: No matching distribution for x\nERROR: more', 'ERROR: No matching'),
        ('killed', 'pip failed'),
        ('  the native core is not built: no; get one\nERROR: x', 'core is not built'),
    ],
)
def test_why_pip_failed(script: ModuleType, words: str, expected: str) -> None:
    what, cure = script.failure(words, Path('setup.log'))
    assert expected in what
    assert cure


def test_it_sets_up_once_and_again_when_the_stamp_is_old(
    script: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    done: list[str] = []

    def make_venv(environment: dict[str, str]) -> None:
        done.append('venv')
        (script.VENV / 'bin').mkdir(parents=True, exist_ok=True)
        for name in ('python', 'pip'):
            (script.VENV / 'bin' / name).touch()

    monkeypatch.setattr(script, 'make_venv', make_venv)
    monkeypatch.setattr(script, 'pip', lambda environment, *arguments: done.append(arguments[-1]))
    script.make_ready({}, {'bag', 'ros'})
    assert done[0] == 'venv'
    assert done[-2:] == [str(script.HASHES), f'{ROOT}[bag,ros]']
    done.clear()
    script.make_ready({}, {'bag'})
    assert done == []
    script.make_ready({}, {'bag', 'lint'})  # adds, and forgets nothing
    assert done == [f'{ROOT}[bag,lint,ros]']
    done.clear()
    stamp = script.VENV / 'tree_sway_ros.stamp'
    version, root, _, extras = stamp.read_text().split('\n')
    stamp.write_text(f'{version}\n{root}\nanother\n{extras}')
    script.make_ready({}, {'bag'})
    assert done == [str(script.HASHES), f'{ROOT}[bag,lint,ros]']
    done.clear()
    stamp.write_text(f'2.7\n{root}\nanother\n{extras}')
    script.make_ready({}, {'bag'})
    assert done[0] == 'venv'
    assert done[-1] == f'{ROOT}[bag]'
    share = script.VENV / 'share' / 'tree_sway_ros'
    files = {name for _, _, names in os.walk(share) for name in names}  # as `ros2 launch` looks
    assert {'package.xml', 'sway.launch.py', 'solver.yaml', 'tree_sway.rviz'} <= files
    assert (script.VENV / 'share/ament_index/resource_index/packages/tree_sway_ros').exists()


def test_the_readme_has_the_command_that_the_checks_run() -> None:
    command = 'python3 .ci/in_venv.py pytest'
    assert command in (ROOT / 'README.md').read_text()
    assert 'step here pytest' in (ROOT / '.ci' / 'run').read_text()


def test_every_ros_wheel_is_held_to_a_hash(script: ModuleType) -> None:
    pinned = script.CONSTRAINTS.read_text().split()
    lines = script.HASHES.read_text().replace('\\\n', '').splitlines()[1:]
    by_requirement = {line.split()[0]: line.split()[1:] for line in lines}
    assert set(by_requirement) == set(pinned)
    for hashes in by_requirement.values():
        assert hashes
        assert all(re.fullmatch('--hash=sha256:[0-9a-f]{64}', each) for each in hashes)
