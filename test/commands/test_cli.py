# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The command line: what is found, what is refused, and how it says so."""

from __future__ import annotations

import argparse
from collections.abc import Callable
import importlib
import importlib.util
import os
from pathlib import Path
import re
import subprocess
import sys
import warnings

import pytest

from tree_sway import extras
from tree_sway.commands import cli
from tree_sway.errors import MissingDependencyError
from tree_sway.files.export import table_writing
from tree_sway.pictures import animation

SEEDLING = Path(__file__).parents[1] / 'files' / 'data' / 'seedling.yaml'
#: All commands but those of the laboratory.
ALL, _ = cli._table('')


def run(*arguments: str) -> tuple[int, str]:
    """Exit code of a command line, whether it returns or raises it."""
    try:
        return cli.main(arguments), ''
    except SystemExit as error:
        return int(error.code or 0), ''


def one_line(text: str) -> str:
    """Return the only line of a text, but for what a busy machine is said to be at."""
    lines = [line for line in text.strip().splitlines() if line != 'opening benjamina ...']
    assert len(lines) == 1, text
    return lines[0]


def test_help_is_a_command_too(capsys: pytest.CaptureFixture[str]) -> None:
    assert run('help', 'plot')[0] == 0
    assert capsys.readouterr().out.startswith('usage: tree-sway plot ')


def test_the_file_to_write_may_be_the_last_word(tmp_path: Path) -> None:
    path = tmp_path / 'seedling.glb'
    assert run('convert', str(SEEDLING), '--leaves', 'off', str(path)) == (0, '')
    assert path.stat().st_size


@pytest.mark.parametrize(
    ('arguments', 'expected'),
    [
        ([], 'required: COMMAND'),
        (['sway'], "invalid choice: 'sway'"),
        (['dmeo'], "did you mean 'demo'?"),
        (['--verison'], "unrecognized arguments: --verison; did you mean '--version'?"),
        (['-V'], "unrecognized arguments: -V; did you mean '--version'?"),
        (['--'], 'required: COMMAND'),
        (['show', 'oak', '--leaf', 'on'], "--leaf on; did you mean '--leaves'?"),
        (['show', 'oak', '-leaves', 'on'], "-leaves on; did you mean '--leaves'?"),
        (['demo', '--sped', '3'], "unrecognized arguments: --sped; did you mean '--speed'?"),
        (
            ['calibrate', 'benjamina', '--at', '3'],
            'unrecognized arguments: --at 3; example: tree-sway calibrate goldcrest',
        ),
        (['plot', 'benjamina', '--model', 'ful'], "did you mean 'full'?"),
        (['convert', 'benjamina'], '--output: no file to write; name it last'),
        (
            ['calibrate', 'benjamina', '--frequency', '3'],
            '--output: no file to write; name it last',
        ),
        (
            ['convert', 'benjamina', 'a.yaml', 'b.yaml'],
            'unrecognized arguments: a.yaml b.yaml; example: tree-sway convert goldcrest -o',
        ),
        (
            ['simulate', 'benjamina', '--seconds', '12m'],
            "--seconds: '12m' is no number; give it in s, with a point",
        ),
        (
            ['grow', 'oak', '--height', '0,45', '-o', 'a.yaml'],
            "--height: '0,45' is no number; give it in m, with a point",
        ),
        (['info', 'benjamina', '--seed', '1.5'], "'1.5' is no whole number; give it as 12"),
        (
            ['info', 'oak'],
            "it is a species: tree-sway grow oak --height 10 -o oak.yaml, or grow('oak', 10)",
        ),
        (['info', 'oka'], "no tree 'oka'; did you mean 'oak'? give a file, or one of benjamina"),
        (['simulate', 'benjamina', '--hz', '20'], "--hz 20; did you mean '--rate'?"),
        (['info', 'benjamina', '--speed'], 'write one behind it, as --speed U;'),
        (
            ['simulate', 'benjamina', '--speed', '10', 'm/s', '-o', 'x.csv'],
            "leave out 'm/s', as numbers have the units of --help",
        ),
        (['grow', 'oak'], 'required: --height; example: tree-sway grow'),
        (['info', 'x' * 300], 'File name too long'),
        (['info'], 'required: TREE'),
        (['info', 'nope'], "no tree 'nope'; give a file, or one of benjamina"),
        (['info', 'benjamin'], "did you mean 'benjamina'?"),
        (['info', 'benjamina', '--species', 'xyzzy'], "unknown species 'xyzzy'; use one of"),
        (['info', 'benjamina', '--species', 'brich'], "did you mean 'birch'? use one of: alder"),
        (['info', 'benjamina', '--modulus', '-1'], '--modulus: -1 is not a finite number above 0'),
        (['info', 'benjamina', '--density', 'nan'], '--density: nan is not a finite number'),
        (['info', 'benjamina', '--density', 'inf'], '--density: inf is not a finite number'),
        (['info', 'benjamina', '--count', '0'], '--count: 0 is out of range; use 1 to'),
        (['info', 'benjamina', '--seed', '-1'], 'seed: -1 is out of range'),
        (['show', '--seconds', '-5'], '--seconds: -5.0 is out of range'),
        (['plot', '--seconds', '0', '-o', 'a.png'], '--seconds: 0.0 is out of range'),
        (['plot', '--wind', '/no/such.csv', '-o', 'a.png'], '/no/such.csv: no such file'),
        (
            ['grow', '--species', 'oak', '--height', 'tall', '-o', 'x'],
            "--height: 'tall' is no number; give it in m",
        ),
        (['grow', '--species', 'oak', '--height', '12', '-o', 'x.doc'], "cannot write '.doc'"),
        (['grow', '--height', '12', '-o', 'x.yaml'], 'no species; give one, as in tree-sway grow'),
        (
            ['grow', 'oak', '--species', 'ash', '--height', '12', '-o', 'x.yaml'],
            'two species, oak and ash',
        ),
        (['grow', 'oka', '--height', '12', '-o', 'x.yaml'], "did you mean 'oak'?"),
        (
            ['convert', 'no_such_tree', '-o', 'x.stl'],
            "cannot write '.stl'; use .yaml, .yml, .glb, .npz, .sway, .html, .usda, .usdz, "
            '.xml (MJCF), .sdf, .obj',
        ),
        (['lab', 'bench', 'jog'], "invalid choice: 'jog'"),
        (['lab', 'bench', 'step', '--rounds', '0'], '--rounds: 0'),
        (['demo', '--seconds', '-1'], '--seconds: -1'),
        (['lab', 'docs', '/no/README.md'], '/no/README.md: No such file'),
    ],
)
def test_what_the_user_can_mend_is_one_line_and_exit_code_2(
    arguments: list[str], expected: str, capsys: pytest.CaptureFixture[str],
    installed: Callable[..., None],
) -> None:  # fmt: skip
    if arguments:
        installed(*arguments)
    code, _ = run(*arguments)
    out, err = capsys.readouterr()
    assert code == 2
    assert out == ''
    line = one_line(err)
    assert line.startswith('tree-sway')
    assert expected in line


def test_help_and_version_need_no_module(capsys: pytest.CaptureFixture[str]) -> None:
    assert run('--help')[0] == 0
    text = capsys.readouterr().out
    listed = {line.split()[0] for line in text.splitlines() if line.startswith('    ')}
    assert set(ALL) <= listed
    assert run('--version')[0] == 0
    assert capsys.readouterr().out.count('.') == 2


@pytest.mark.parametrize('command', ALL)
def test_every_command_has_its_module_and_help(
    command: str, capsys: pytest.CaptureFixture[str], installed: Callable[..., None]
) -> None:
    installed(command)
    assert run(command, '--help')[0] == 0
    text = ' '.join(capsys.readouterr().out.split())
    assert f'usage: tree-sway {command}' in text
    summary, example = ALL[command].summary, ALL[command].example
    assert f'{summary[0].upper()}{summary[1:]}.' in text  # DDS and MuJoCo keep their capitals
    assert f'example: tree-sway {example}' in text


@pytest.mark.parametrize('command', ALL)
def test_the_example_of_a_command_is_one_of_it(command: str) -> None:
    example = ALL[command].example.split()
    assert cli._parser(command, ALL, '').parse_args(example).command == command


CURES = [
    ('serial.tools', 'sensors'),
    ('PIL', 'plot'),
    ('pyarrow', 'parquet'),
    ('geometry_msgs.msg', 'ros'),
]


@pytest.mark.parametrize(('module', 'extra'), CURES)
def test_the_cure_for_a_missing_module_is_from_our_own_table(
    module: str, extra: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """From the folder of the installation, by in_venv.py in its environment, else by its name."""
    monkeypatch.setattr(extras, '_folder', lambda: None)
    assert f'pip install "tree_sway_ros[{extra}]"' in extras.cure_of_missing(module, 'plot')
    monkeypatch.setattr(extras, '_folder', lambda: tmp_path)
    monkeypatch.setattr(sys, 'prefix', str(tmp_path))
    assert f'pip install "{tmp_path}[{extra}]"' in extras.cure_of_missing(module, 'plot')
    (tmp_path / 'tree_sway_ros.stamp').touch()
    cure = extras.cure_of_missing(module, 'plot oak.yaml')
    assert cure.endswith(f'python3 {tmp_path}/.ci/in_venv.py tree-sway plot oak.yaml')
    monkeypatch.chdir(tmp_path)
    cure = extras.cure_of_missing(module, 'plot oak.yaml')
    assert cure.endswith(': python3 .ci/in_venv.py tree-sway plot oak.yaml')
    for each in ('left_pad', module):  # a name of a module may be that of a different project
        assert f'pip install {each.partition(".")[0]}' not in extras.cure_of_missing(each)
    assert 'install tree_sway_ros again' in extras.cure_of_missing('left_pad')


def test_a_missing_module_is_one_line_with_its_cure(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def missing(_name: str) -> object:
        raise ModuleNotFoundError("No module named 'tqdm'", name='tqdm')

    monkeypatch.setattr(cli.importlib, 'import_module', missing)
    monkeypatch.setattr(cli, '_parser', lambda *_: argparse.Namespace(parse_known_args=lambda _:
        (argparse.Namespace(quiet=False, command='info'), [])))  # fmt: skip
    assert cli.main(['info', 'two words']) == 2
    assert extras.cure_of_missing('tqdm', "info 'two words'") in one_line(capsys.readouterr().err)


@pytest.mark.parametrize(
    ('arguments', 'module'),
    [
        ('plot no_such_tree -o a.png', 'matplotlib'),
        ('render no_such_tree -o a.gif', 'matplotlib'),
        ('render no_such_tree -o a.mp4', 'imageio_ffmpeg'),
        ('study no_such_study.yaml -o a.csv', 'distributed'),
        ('study no_such_study.yaml -o a.parquet', 'pyarrow'),
        ('simulate no_such_tree -o a.parquet', 'pyarrow'),
        ('demo no_such_tree', 'rclpy'),
        ('record -o bag', 'rosbags'),
    ],
)
def test_a_command_says_what_it_lacks_before_it_opens_anything(
    arguments: str, module: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path,
    capsys: pytest.CaptureFixture[str], installed: Callable[..., None],
) -> None:  # fmt: skip
    words = arguments.split()
    installed(*words)
    if words[0] == 'record':
        pytest.importorskip('rclpy', reason='a bag needs ROS 2')
    find, load = importlib.util.find_spec, importlib.import_module

    def no_spec(name: str, package: str | None = None) -> object:
        return None if name == module else find(name, package)

    def no_module(name: str, package: str | None = None) -> object:
        if name == module:
            raise ModuleNotFoundError(f"No module named '{name}'", name=name)
        return load(name, package)

    monkeypatch.setattr(extras, 'find_spec', no_spec)
    monkeypatch.setattr(table_writing, 'find_spec', no_spec)
    monkeypatch.setattr(animation, 'import_module', no_module)
    monkeypatch.chdir(tmp_path)
    assert cli.main(words) == 2
    printed = one_line(capsys.readouterr().err)
    assert module in printed
    assert extras.cure_of_missing(module).rpartition(' ')[0] in printed


def test_the_cure_of_a_reader_has_the_whole_command(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def missing(*_: object) -> None:
        monkeypatch.setattr(extras, 'line_in_venv', 'python3 in_venv.py tree-sway {}'.format)
        raise MissingDependencyError('no openpyxl', cure=extras.cure_of_missing('openpyxl'))

    monkeypatch.setattr(cli, 'refuse_missing', missing)
    assert cli.main(['info', 'two words.xlsx', '--count', '1']) == 2
    said = one_line(capsys.readouterr().err)
    assert said.endswith("python3 in_venv.py tree-sway info 'two words.xlsx' --count 1")


def test_every_extra_that_is_advised_is_one_of_the_package() -> None:
    text = (Path(__file__).parents[2] / 'setup.py').read_text(encoding='utf-8')
    for extra in {*(each.name for each in extras.EXTRAS.values()), 'ros'}:
        assert f"    '{extra}': [" in text
    named = set(re.findall(r"'([\w-]+)>=([\d.]+)", text))
    for module, (_, distribution, least) in extras.EXTRAS.items():
        if module not in ('PIL', 'dask'):  # brought by those of their extra
            assert (distribution, least) in named


def test_a_package_that_is_too_old_is_refused_with_the_version_that_is_needed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    versions = {'pyserial': '3.4.1', 'tqdm': '4.60.0', 'pillow': '10.2.0.dev1'}
    monkeypatch.setattr(extras, '_version', lambda name: versions.get(name, ''))
    monkeypatch.setattr(extras, 'find_spec', lambda _: object())
    extras.refuse_missing(['tqdm', 'PIL', 'rclpy'], '...')
    with pytest.raises(MissingDependencyError, match=r'pyserial 3.4.1 is too old: 3.5 or newer'):
        extras.refuse_missing(['serial'], '...')


def test_a_warning_is_a_note_on_one_line(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    class Slow:
        """A command that warns."""

        @staticmethod
        def add_arguments(parser: object) -> None:
            """None."""

        @staticmethod
        def run(arguments: object) -> int:
            warnings.warn('tqdm is\nnot installed', RuntimeWarning, stacklevel=1)
            return 0

    monkeypatch.setattr(cli, '_module', lambda command: Slow)
    assert cli.main(['info']) == 0
    assert capsys.readouterr().err == 'note: tqdm is not installed\n'


def test_a_missing_module_of_ours_is_a_fault_and_not_hidden(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def missing(name: str) -> object:
        raise ModuleNotFoundError('gone', name='tree_sway.core.gone')

    monkeypatch.setattr(cli, '_module', missing)
    with pytest.raises(ModuleNotFoundError):
        cli.main(['info', 'benjamina'])


def test_quiet_leaves_errors_alone(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    out = str(tmp_path / 'tree.glb')
    assert cli.main(['convert', 'goldcrest', '-o', out, '--quiet']) == 0
    assert capsys.readouterr().err == ''
    assert cli.main(['info', 'nope', '--quiet']) == 2
    assert "no tree 'nope'" in one_line(capsys.readouterr().err)


@pytest.mark.parametrize('command', [['convert', 'goldcrest'], ['plot', 'goldcrest']])
def test_a_file_that_is_there_is_not_written_over_in_silence(
    command: list[str], capsys: pytest.CaptureFixture[str], tmp_path: Path,
    installed: Callable[..., None],
) -> None:  # fmt: skip
    installed(*command)
    path = tmp_path / 'tree.glb'
    path.write_text('mine')
    assert cli.main([*command, '-o', str(path)]) == 2
    assert 'exists; give a different file, or write over it' in capsys.readouterr().err
    assert path.read_text() == 'mine'


def test_a_file_is_written_over_with_force(tmp_path: Path) -> None:
    path = tmp_path / 'tree.glb'
    path.write_text('mine')
    assert cli.main(['convert', 'goldcrest', '-o', str(path), '--force']) == 0
    assert path.read_bytes() != b'mine'


def run_process(command: str, **environment: str) -> subprocess.CompletedProcess[str]:
    """Run a line of bash in which $TREE_SWAY is this command line."""
    return subprocess.run(
        ['bash', '-o', 'pipefail', '-c', command],
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, 'TREE_SWAY': f'{sys.executable} -m tree_sway'} | environment,
    )


@pytest.mark.skipif(not Path('/dev/full').exists(), reason='needs the device /dev/full')
def test_a_full_disk_under_standard_output_is_one_line() -> None:
    for unbuffered in ('', '1'):
        line = f'$TREE_SWAY info {SEEDLING} --quiet > /dev/full'
        result = run_process(line, PYTHONUNBUFFERED=unbuffered)
        assert result.returncode == 2
        assert 'No space left on device' in one_line(result.stderr)


@pytest.mark.parametrize('where', ['>&-', '2>&-', '>&- 2>&-'])
def test_closed_output_is_no_error(where: str) -> None:
    result = run_process(f'$TREE_SWAY info {SEEDLING} {where}')
    assert result.returncode == 0
    assert 'Traceback' not in result.stderr


def test_letters_that_a_terminal_lacks_are_escaped(tmp_path: Path) -> None:
    plain = {'LC_ALL': 'C', 'PYTHONUTF8': '0', 'PYTHONCOERCECLOCALE': '0'}
    name = tmp_path / 'b\u00e4um.yaml'
    result = run_process(f"$TREE_SWAY convert {SEEDLING} -o '{name}'", **plain)
    assert result.returncode == 0, result.stderr
    assert 'um.yaml: seedling' in result.stdout


def test_no_name_from_a_file_steers_the_terminal(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    evil = tmp_path / 'a\x1b[31mb.yaml'
    text = SEEDLING.read_text()
    evil.write_text(text.replace('name: seedling', r'name: "oak\e[2J\rx\nmass 3 kg\u202Eend"', 1))
    for words in (
        ('info', str(evil)),
        ('convert', str(evil), '-o', 'plain.yaml'),
        ('convert', 'plain.yaml', '-o', 'c\x1b[31md.glb'),
    ):
        assert run(*words)[0] == 0
        said = capsys.readouterr()
        assert r'oak\x1b[2J x mass 3 kg\u202eend' in said.out
        assert all(c.isprintable() or c == '\n' for c in said.out + said.err)


def test_a_reader_that_goes_away_is_no_error() -> None:
    command = f'{sys.executable} -m tree_sway info goldcrest --json --quiet | head -1'
    result = subprocess.run(
        ['bash', '-o', 'pipefail', '-c', command], capture_output=True, text=True, check=False
    )
    assert result.stdout == '{\n'
    assert result.stderr == ''


@pytest.mark.parametrize('name', ['~nosuchuser/tree.yaml', 'x' * 300 + '.yaml', 'a\0b.yaml'])
def test_a_name_that_is_no_path_is_one_line(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    for arguments in (
        ('info', name),
        ('convert', 'benjamina', '-o', name),
        ('info', 'benjamina', '--species', name),
        ('calibrate', 'benjamina', '--record', name, '-o', 'x.yaml'),
    ):
        code, _ = run(*arguments)
        assert code == 2
        assert one_line(capsys.readouterr().err)


def test_names_outside_ascii_on_an_ascii_terminal(tmp_path: Path) -> None:
    result = subprocess.run(
        [
            sys.executable,
            '-m',
            'tree_sway',
            'convert',
            'benjamina',
            '-o',
            'Bäume.glb',
            '--quiet',
        ],
        cwd=tmp_path,
        env={**os.environ, 'PYTHONIOENCODING': 'ascii'},
        capture_output=True,
        text=True,
        check=False,
    )
    assert (result.returncode, result.stderr) == (0, '')
    assert r'B\xe4ume.glb: benjamina' in result.stdout
    assert (tmp_path / 'Bäume.glb').is_file()
