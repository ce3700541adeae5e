"""The one-command set-up: what it refuses, what it keeps out, when it does its work again."""

from __future__ import annotations

import importlib.util
import os
import sys
from pathlib import Path
from types import ModuleType

import pytest

ROOT = Path(__file__).resolve().parent.parent
SCRIPT = ROOT / ".ci" / "in_venv.py"


@pytest.fixture
def script(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    """The script as a module, its environment in a folder of the test."""
    monkeypatch.setenv("TREE_SWAY_VENV", str(tmp_path / "venv"))
    spec = importlib.util.spec_from_file_location("in_venv", SCRIPT)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def refusal(capsys: pytest.CaptureFixture[str]) -> str:
    """The one line on standard error."""
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("in_venv: ")
    return line


def test_no_command(script: ModuleType, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit, match="2"):
        script.main([])
    assert "no command given" in refusal(capsys)


@pytest.mark.parametrize("version", [(3, 9, 18), (3, 14, 0)])
def test_a_python_without_wheels(
    script: ModuleType,
    version: tuple[int, int, int],
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr(sys, "version_info", version)
    with pytest.raises(SystemExit, match="2"):
        script.check_machine()
    assert "does not fit, 3.10 to 3.13 do; run it with" in refusal(capsys)


def test_a_machine_without_wheels(
    script: ModuleType, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(script.platform, "machine", lambda: "aarch64")
    with pytest.raises(SystemExit, match="2"):
        script.check_machine()
    assert "x86_64 Linux, not aarch64" in refusal(capsys)


def test_a_python_without_ensurepip(
    script: ModuleType, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "ensurepip", None)
    with pytest.raises(SystemExit, match="2"):
        script.make_venv({})
    assert "sudo apt install python3-venv" in refusal(capsys)


def test_a_sourced_ros_is_left_aside(
    script: ModuleType, capsys: pytest.CaptureFixture[str]
) -> None:
    sourced = {
        "ROS_DISTRO": "jazzy",
        "AMENT_PREFIX_PATH": "/opt/ros/jazzy",
        "PYTHONPATH": "/opt/ros/jazzy/lib/python3.12/site-packages",
        "LD_LIBRARY_PATH": "/opt/ros/jazzy/lib",
        "PATH": "/opt/ros/jazzy/bin:/usr/bin",
        "ROS_DOMAIN_ID": "7",
        "HOME": "/home/me",
    }
    kept = script.without_ros(sourced)
    assert kept == {"PATH": "/usr/bin", "ROS_DOMAIN_ID": "7", "HOME": "/home/me"}
    assert "leaving the sourced jazzy aside" in refusal(capsys)


def test_a_shell_without_ros_is_left_alone(
    script: ModuleType, capsys: pytest.CaptureFixture[str]
) -> None:
    plain = {"PATH": "/usr/bin", "PYTHONPATH": "/mine", "LD_LIBRARY_PATH": "/mine"}
    assert script.without_ros(plain) == plain
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        ("WARNING: ... NewConnectionError('<pip._vendor...", "no network"),
        ("ERROR: ... [Errno 28] No space left on device", "the disk is full"),
        ("so it goes\nERROR: No matching distribution for x\nERROR: more", "ERROR: No matching"),
        ("killed", "pip failed"),
    ],
)
def test_why_pip_failed(script: ModuleType, words: str, expected: str) -> None:
    what, cure = script.failure(words, Path("setup.log"))
    assert expected in what
    assert cure


def test_it_sets_up_once_and_again_when_the_stamp_is_old(
    script: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    done: list[str] = []

    def make_venv(environment: dict[str, str]) -> None:
        done.append("venv")
        (script.VENV / "bin").mkdir(parents=True, exist_ok=True)
        for name in ("python", "pip"):
            (script.VENV / "bin" / name).touch()

    monkeypatch.setattr(script, "make_venv", make_venv)
    monkeypatch.setattr(script, "pip", lambda environment, *arguments: done.append(arguments[-1]))
    target = f"{ROOT}[{script.EXTRAS}]"
    script.make_ready({})
    assert done[0] == "venv"
    assert done[-1] == target
    done.clear()
    script.make_ready({})
    assert done == []
    stamp = script.VENV / "tree_sway_ros.stamp"
    version, root, _ = stamp.read_text().split()
    stamp.write_text(f"{version} {root} another")
    script.make_ready({})
    assert "venv" not in done
    assert done[-1] == target
    done.clear()
    stamp.write_text(f"2.7 {root} another")
    script.make_ready({})
    assert done[0] == "venv"
    share = script.VENV / "share" / "tree_sway_ros"
    files = {name for _, _, names in os.walk(share) for name in names}  # as `ros2 launch` looks
    assert {"package.xml", "sway.launch.py", "solver.yaml", "tree_sway.rviz"} <= files
    assert (script.VENV / "share/ament_index/resource_index/packages/tree_sway_ros").exists()


def test_the_readme_has_the_command_that_the_checks_run() -> None:
    command = "python3 .ci/in_venv.py pytest"
    assert command in (ROOT / "README.md").read_text()
    assert ".ci/in_venv.py pytest" in (ROOT / ".ci" / "run").read_text()
