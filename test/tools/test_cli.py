"""The command line: what is found, what is refused, and how it says so."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tree_sway_ros.tools import cli


def run(*arguments: str) -> tuple[int, str]:
    """Exit code of a command line, whether it returns or raises it."""
    try:
        return cli.main(arguments), ""
    except SystemExit as error:
        return int(error.code or 0), ""


def one_line(text: str) -> str:
    """The only line of a text."""
    lines = text.strip().splitlines()
    assert len(lines) == 1, text
    return lines[0]


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        ([], "required: COMMAND"),
        (["sway"], "invalid choice: 'sway'"),
        (["info"], "required: TREE"),
        (["info", "nope"], "no tree 'nope'; give a file, or one of benjamina"),
        (["info", "benjamin"], "did you mean 'benjamina'?"),
        (["info", "benjamina", "--species", "elm"], "unknown species 'elm'; use one of: ash"),
        (["info", "benjamina", "--modulus", "-1"], "--modulus: -1 is not positive"),
        (["info", "benjamina", "--density", "nan"], "--density: nan is not positive"),
        (["info", "benjamina", "--count", "0"], "--count: 0 frequencies"),
        (["info", "benjamina", "--seed", "-1"], "seed -1 is negative"),
        (["plot", "--seconds", "0"], "--seconds: 0 s"),
        (["plot", "--wind", "/no/such.csv"], "/no/such.csv: no such file"),
        (
            ["grow", "--species", "oak", "--height", "tall", "-o", "x"],
            "invalid float value: 'tall'",
        ),
        (["grow", "--species", "oak", "--height", "12", "-o", "x.doc"], "cannot write '.doc'"),
        (["bench", "jog"], "invalid choice: 'jog'"),
        (["bench", "step", "--rounds", "0"], "--rounds: 0"),
        (["demo", "--seconds", "-1"], "--seconds: -1"),
        (["docs", "/no/README.md"], "/no/README.md: No such file"),
    ],
)
def test_what_the_user_can_mend_is_one_line_and_exit_code_2(
    arguments: list[str], expected: str, capsys: pytest.CaptureFixture[str]
) -> None:
    code, _ = run(*arguments)
    out, err = capsys.readouterr()
    assert code == 2
    assert out == ""
    line = one_line(err)
    assert line.startswith("tree-sway")
    assert expected in line


def test_help_and_version_need_no_module(capsys: pytest.CaptureFixture[str]) -> None:
    assert run("--help")[0] == 0
    text = capsys.readouterr().out
    listed = {line.split()[0] for line in text.splitlines() if line.startswith("    ")}
    assert set(cli.COMMANDS) <= listed
    assert run("--version")[0] == 0
    assert capsys.readouterr().out.count(".") == 2


@pytest.mark.parametrize("command", cli.COMMANDS)
def test_every_command_has_its_module_and_help(
    command: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(command, "--help")[0] == 0
    assert f"usage: tree-sway {command}" in capsys.readouterr().out


def test_a_missing_package_is_one_line(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def missing(name: str) -> object:
        raise ModuleNotFoundError("No module named 'numba'", name="numba")

    monkeypatch.setattr(cli, "_module", missing)
    assert run("info", "benjamina")[0] == 2
    assert "No module named 'numba'; install" in one_line(capsys.readouterr().err)


def test_a_missing_module_of_ours_is_a_fault_and_not_hidden(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def missing(name: str) -> object:
        raise ModuleNotFoundError("gone", name="tree_sway_ros.core.gone")

    monkeypatch.setattr(cli, "_module", missing)
    with pytest.raises(ModuleNotFoundError):
        cli.main(["info", "benjamina"])


def test_a_reader_that_goes_away_is_no_error() -> None:
    command = f"{sys.executable} -m tree_sway_ros.tools.cli info goldcrest --json | head -1"
    result = subprocess.run(
        ["bash", "-o", "pipefail", "-c", command], capture_output=True, text=True, check=False
    )
    assert result.stdout == "{\n"
    assert result.stderr == ""


@pytest.mark.parametrize("name", ["~nosuchuser/tree.yaml", "x" * 300 + ".yaml", "a\0b.yaml"])
def test_a_name_that_is_no_path_is_one_line(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    for arguments in (
        ("info", name),
        ("convert", "benjamina", "-o", name),
        ("info", "benjamina", "--species", name),
        ("calibrate", "benjamina", "--record", name, "-o", "x.yaml"),
    ):
        code, _ = run(*arguments)
        assert code == 2
        assert one_line(capsys.readouterr().err)


def test_names_outside_ascii_on_an_ascii_terminal(tmp_path: Path) -> None:
    result = subprocess.run(
        [
            sys.executable,
            "-m",
            "tree_sway_ros.tools.cli",
            "convert",
            "benjamina",
            "-o",
            "Bäume.obj",
        ],
        cwd=tmp_path,
        env={**os.environ, "PYTHONIOENCODING": "ascii"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert (result.returncode, result.stderr) == (0, "")
    assert r"B\xe4ume.obj: benjamina" in result.stdout
    assert (tmp_path / "Bäume.obj").is_file()
