# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The command line ``tree-sway``: one module per command, imported when it is called.

A module of a command has ``add_arguments(parser)`` and ``run(arguments) -> int``. Errors that the
user can correct are one line on standard error and exit code 2.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
import contextlib
import errno
import importlib
import io
import os
import re
import shlex
import sys
from typing import Any, NoReturn
import warnings

from tree_sway.commands.command import Command
from tree_sway.commands.entries import commands_called, other_groups, own_commands
from tree_sway.commands.escaped_text import escaped_output
from tree_sway.errors import nearest, shown, TreeSwayError
from tree_sway.extras import cure_of_missing, line_in_venv, refuse_missing

_FAILURE = 2
_INTERRUPTED = 130
_CHOICE = re.compile(r"invalid choice: '([^']*)' \(choose from (.*)\)")
_NO_NUMBER = re.compile(r"argument (\S+): invalid (float|int) value: '(.*)'")
_UNIT = re.compile(r'\[([^]%]+)\]')
_UNRECOGNIZED = re.compile(r'unrecognized arguments: (?:\S+ )*?(-[\w-]+)')
_LEFT = re.compile(r'unrecognized arguments: ([^-]\S*)$')
_NO_VALUE = re.compile(r'argument (\S+): expected one argument')
_OTHER_WORDS = {
    'hz': 'rate', 'fps': 'rate', 'duration': 'seconds', 'time': 'seconds', 'file': 'output',
    'wind-speed': 'speed', 'size': 'pixels', 'dbh': 'diameter', 'overwrite': 'force',
    'leaf': 'leaves', 'V': 'version', 'v': 'version',
}  # fmt: skip
"""Words that options are sought by."""


class _OneLineParser(argparse.ArgumentParser):
    """Parser whose errors are one line, without usage, and with the nearest name."""

    chosen: argparse.ArgumentParser | None = None

    def error(self, message: str) -> NoReturn:
        """Print the error and where to read more, and exit."""
        guess = ''
        if wrong := _CHOICE.search(message):
            guess = nearest(wrong[1], re.findall(r'[\w.-]+', wrong[2]))
        elif wrong := _UNRECOGNIZED.search(message):
            guess = self._nearest_option(wrong[1].lstrip('-'))
        elif wrong := _LEFT.search(message):
            if wrong[1] in self._units():
                guess = f"leave out '{wrong[1]}', as numbers have the units of --help"
        elif wrong := _NO_VALUE.search(message):
            action = self._action(wrong[1])
            guess = f'write one behind it, as {wrong[1]} {action.metavar or action.dest.upper()}'
        elif wrong := _NO_NUMBER.search(message):
            what, form = ('number', 'with a point, as 12 or 0.45')
            if wrong[2] == 'int':
                what, form = ('whole number', 'as 12')
            message = f"argument {wrong[1]}: '{wrong[3]}' is no {what}"
            guess = f'give it {self._unit_of(wrong[1])}{form}'
        example = str((self.chosen or self).epilog)
        is_of_use = message.startswith(('unrecognized', 'the following'))
        if not guess and is_of_use and example.startswith('example'):
            guess = example
        where = (self.chosen or self).prog
        text = '; '.join(filter(None, (message, guess, f'see {where} --help')))
        print(f'{where}: {text}', file=sys.stderr)
        raise SystemExit(_FAILURE)

    def _nearest_option(self, word: str) -> str:
        """Return a question whether an option is meant by a word."""
        names = [name[2:] for name in (self.chosen or self)._option_string_actions if name[2:]]
        other = _OTHER_WORDS.get(word)
        question = f"did you mean '{other}'?" if other in names else nearest(word, names)
        return question.replace("'", "'--", 1)

    def _action(self, names: str) -> argparse.Action:
        """Return the argument that an error names."""
        actions = (self.chosen or self)._actions
        return next(each for each in actions if '/'.join(each.option_strings) == names)

    def _units(self) -> set[str]:
        """Return the units that the help has."""
        return {
            each for a in (self.chosen or self)._actions for each in _UNIT.findall(str(a.help))
        }

    def _unit_of(self, names: str) -> str:
        """Return the unit that the help of an argument has, as 'in m, '."""
        unit = _UNIT.search(str(self._action(names).help))
        return f'in {unit[1]}, ' if unit else ''


def main(argv: Sequence[str] | None = None) -> int:
    """
    Run a command by its arguments, `sys.argv` if None.

    The exit code is 0, or 2 for an error that the user can correct, with one line on how.
    """
    with escaped_output(), warnings.catch_warnings():
        warnings.showwarning = _show_warning  # type: ignore[assignment]
        given = list(sys.argv[1:] if argv is None else argv)
        return _main([*given[1:], '--help'] if given[:1] == ['help'] else given)


def _main(given: list[str]) -> int:
    first = given[0] if given else ''
    try:
        table, group = _table(first)
    except TreeSwayError as error:
        return _fail(first, str(error))
    command = given[bool(group)] if len(given) > bool(group) else ''
    if command == 'lab' and not group:
        return _fail(command, _cure_of_laboratory(shlex.join(given)))
    missing = [] if command in table else own_commands()[1]
    if missing and (command[:1] not in ('', '-') or not table):
        cure = cure_of_missing('tree_sway', shlex.join(given))
        return _fail(command, f'the commands of {", ".join(missing)} are missing; {cure}')
    try:
        arguments = _parsed(_parser(command, table, group), given[bool(group) :])
        # This is without notes and progress: errors are printed afterwards.
        quiet = contextlib.redirect_stderr(io.StringIO()) if arguments.quiet else None
        with quiet or contextlib.nullcontext():
            refuse_missing(table[arguments.command].needs.split(), shlex.join(given))
            # Imported here, as numpy takes long enough for a Ctrl-C, which is then no traceback.
            importlib.import_module('tree_sway.files.models').use_disk_cache()
            code = int(_module(table[arguments.command]).run(arguments))
            if sys.stdout is not None:
                sys.stdout.flush()  # a full disk is reported here, not while Python ends
        return code
    except TreeSwayError as error:
        line = shlex.join(['tree-sway', *given])
        return _fail(command, str(error).replace('tree-sway ...', line))
    except ModuleNotFoundError as error:
        if str(error.name).startswith('tree_sway'):
            raise
        return _fail(command, f'{error}; {cure_of_missing(str(error.name), shlex.join(given))}')
    except BrokenPipeError:  # the reader of our output has ended
        _give_up_output()
        return 0
    except OSError as error:
        if error.errno == errno.ENOSPC and not error.filename:
            _give_up_output()
        where = f'{shown(str(error.filename))}: ' if error.filename else ''
        return _fail(command, f'{where}{error.strerror or error}')
    except KeyboardInterrupt:
        return _INTERRUPTED


def _give_up_output() -> None:
    """Prevent a further error when Python flushes what could not be written."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _parsed(parser: _OneLineParser, given: list[str]) -> argparse.Namespace:
    """Parse arguments; a last word that is left is the file to write, where none is named."""
    arguments, left = parser.parse_known_args(given)
    if (
        left == given[-1:]
        and not left[0].startswith('-')
        and vars(arguments).get('output', '') is None
    ):
        arguments.output = left.pop()
    if left:
        parser.error(f'unrecognized arguments: {" ".join(left)}')
    return arguments


def _show_warning(message: Warning | str, *_where: Any) -> None:
    """Print warnings of libraries on one line, without the line of code."""
    if sys.stderr is not None:
        print(f'note: {" ".join(str(message).split())}', file=sys.stderr)


def _fail(command: str, text: str) -> int:
    print(f'tree-sway {command}: {" ".join(text.split())}', file=sys.stderr)
    return _FAILURE


def _cure_of_laboratory(line: str) -> str:
    install = line_in_venv(line) or 'pip install ./lab in the checkout'
    return f'it belongs to the laboratory: {install}'


def _table(first: str) -> tuple[dict[str, Command], str]:
    """Return the commands for the first word, and the name of their group."""
    table, _ = own_commands()
    # All installed packages are searched only when needed.
    if first and not first.startswith('-') and first not in table:
        called = commands_called(first)
        if called is not None:
            return called, first
    return table, ''


def _module(command: Command) -> Any:
    return importlib.import_module(command.module)


def _parser(chosen: str, table: dict[str, Command], group: str) -> _OneLineParser:
    """Parse all commands, but only the arguments of the given one, as imports take long."""
    program = f'tree-sway {group}'.strip()
    parser = _OneLineParser(prog=program, description='Trees that sway in measured wind.')
    if not group and chosen.startswith('-') and (others := other_groups()):
        called = ', '.join(f'{program} {each}' for each in others)
        parser.epilog = f'commands of other packages: {called}'
    version = importlib.import_module('tree_sway').__version__
    parser.add_argument('--version', action='version', version=version)
    is_needed = chosen.strip('-') in ('', chosen)  # behind an option that is misspelt it is not
    commands = parser.add_subparsers(dest='command', metavar='COMMAND', required=is_needed)
    for name, command in table.items():
        sub = commands.add_parser(
            name,
            help=command.summary,
            description=f'{command.summary[0].upper()}{command.summary[1:]}.',
            epilog=f'example: {program} {command.example}',
        )
        sub.add_argument('-q', '--quiet', action='store_true', help='print errors only')
        if name == chosen:
            _module(command).add_arguments(sub)
            parser.chosen = sub
    return parser
