# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
# PYTHON_ARGCOMPLETE_OK
"""
The command line ``tree-sway``: one module per command, imported when it is asked for.

A module of a command has ``add_arguments(parser)`` and ``run(arguments) -> int``. Whatever the
user can mend ends as one line on standard error and exit code 2.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
import contextlib
import importlib
import io
import os
import re
import sys
from typing import Any, NamedTuple, NoReturn
import warnings

from tree_sway_ros.errors import nearest, TreeSwayError


class Command(NamedTuple):
    """What a command does, and an example of it."""

    summary: str
    example: str


COMMANDS: dict[str, Command] = {
    'show': Command(
        'a tree in wind on a page of the browser, without ROS', 'show goldcrest --seconds 10'
    ),
    'demo': Command(
        'a tree sways in wind, all nodes in one process over real DDS',
        'demo goldcrest --speed 8 --seconds 10',
    ),
    'soak': Command(
        'run the chain through every fault of a sensor, and tell what it costs',
        'soak --hours 0.002 --every 1',
    ),
    'listen': Command(
        'count the poses that a solver in another process streams', 'listen --seconds 10'
    ),
    'record': Command(
        'wind, state and description of a running tree as a bag', 'record -o bag --seconds 10'
    ),
    'relay': Command(
        'one tree at several sites: send the wind, and receive it',
        'relay send goldcrest --listen tcp/127.0.0.1:0 --seconds 1',
    ),
    'info': Command('what a tree is: size, masses, natural frequencies', 'info benjamina'),
    'plot': Command(
        'pictures of a tree, and of the wind and the motion of its tip',
        'plot benjamina --seconds 20 -o sway.png',
    ),
    'render': Command(
        'a tree in wind as a moving picture: GIF, MP4 or frames',
        'render goldcrest --speed 9 --seconds 2 -o sway.gif',
    ),
    'grow': Command(
        'make a tree of a species and a height', 'grow --species oak --height 12 -o oak.yaml'
    ),
    'convert': Command('write a tree in another format', 'convert goldcrest -o goldcrest.obj'),
    'calibrate': Command(
        'fit modulus and damping to one measured sway',
        'calibrate goldcrest --frequency 3 -o measured.yaml',
    ),
    'bench': Command('time the solver', 'bench step --rounds 2'),
    'battery': Command(
        'the cases where methods of integration fail, and what ours does there', 'battery T04'
    ),
    'chart': Command(
        'speed against accuracy: of methods, of models, against size', 'chart methods -o charts'
    ),
    'compare': Command(
        'our simulator against MuJoCo, in one run', 'compare goldcrest --seconds 1'
    ),
    'paper': Command(
        'the experiment of Kanda & Ohya as it is written, and what ours does instead', 'paper'
    ),
    'study': Command(
        'many trees in many winds with many settings, over all cores',
        'study study.yaml -o study.csv',
    ),
    'docs': Command('write the tables of topics and parameters into the pages', 'docs --check'),
}

#: Commands of the study, which nothing that runs imports; each is a module ``command`` of
#: its room.
_STUDIES = {
    **{name: name for name in ('bench', 'battery', 'chart', 'compare', 'paper')},
    'study': 'campaign',
    'docs': 'pages',
}

#: Commands that watch a stream.
_STREAMS = ('listen', 'record', 'soak')
_FAILURE = 2
_INTERRUPTED = 130
_CHOICE = re.compile(r"invalid choice: '([^']*)' \(choose from (.*)\)")
_UNRECOGNIZED = re.compile(r'unrecognized arguments: (?:\S+ )*?(--[\w-]+)')


class _OneLineParser(argparse.ArgumentParser):
    """Errors on one line, without the usage before it, and with the name that may be meant."""

    chosen: argparse.ArgumentParser | None = None

    def error(self, message: str) -> NoReturn:
        """Print what is wrong and where to read more, and exit."""
        guess = ''
        if wrong := _CHOICE.search(message):
            guess = nearest(wrong[1], re.findall(r'[\w.-]+', wrong[2]))
        elif wrong := _UNRECOGNIZED.search(message):
            guess = nearest(wrong[1], (self.chosen or self)._option_string_actions)
        where = (self.chosen or self).prog
        told = '; '.join(filter(None, (message, guess, f'see {where} --help')))
        print(f'{where}: {told}', file=sys.stderr)
        raise SystemExit(_FAILURE)


def main(argv: Sequence[str] | None = None) -> int:
    """
    Run a command by its arguments, `sys.argv` if None.

    The exit code is 0, or 2 if the user can mend it, with one line that says how.
    """
    with warnings.catch_warnings():
        warnings.showwarning = _show_warning  # type: ignore[assignment]
        return _main(list(sys.argv[1:] if argv is None else argv))


def _main(given: list[str]) -> int:
    command = given[0] if given else ''
    _write_any_name()
    try:
        parser = _parser(_completed() or command)
        _offer_completion(parser)
        arguments = parser.parse_args(given)
        with _silence() if arguments.quiet else contextlib.nullcontext():
            code = int(_module(arguments.command).run(arguments))
            if sys.stdout is not None:
                sys.stdout.flush()  # a full disk is told here, not while Python ends
        return code
    except TreeSwayError as error:
        return _fail(command, str(error))
    except ModuleNotFoundError as error:
        if str(error.name).startswith('tree_sway_ros'):
            raise
        return _fail(command, f'{error}; install it: pip install {error.name}')
    except BrokenPipeError:
        # Whoever read our output has gone; keep Python from complaining when it flushes.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except OSError as error:
        name = _shortened(str(error.filename))
        return _fail(command, f'{name}: {error.strerror}' if error.filename else str(error))
    except KeyboardInterrupt:
        return _INTERRUPTED


def _show_warning(message: Warning | str, *_where: Any) -> None:
    """Say what a library warns of on one line, without the line of code it stands in."""
    if sys.stderr is not None:
        print(f'note: {" ".join(str(message).split())}', file=sys.stderr)


def _write_any_name() -> None:
    """Have names that a terminal has no letters for printed with escapes, instead of a crash."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors='backslashreplace')


def _silence() -> Any:
    """Take notes and progress away; errors are printed after this ends."""
    return contextlib.redirect_stderr(io.StringIO())


def _fail(command: str, text: str) -> int:
    print(f'tree-sway {command}: {" ".join(text.split())}', file=sys.stderr)
    return _FAILURE


def _shortened(name: str) -> str:
    return name if len(name) <= 80 else f'{name[:60]}...{name[-17:]}'


def _module(command: str) -> Any:
    room = _STUDIES.get(command)
    where = f'study.{room}.command' if room else f'tools.{command}'
    if command in _STREAMS:
        where = f'tools.stream.{command}'
    return importlib.import_module(f'tree_sway_ros.{where}')


def _parser(chosen: str) -> _OneLineParser:
    """Parse all commands, but only the chosen one's arguments, as importing others takes long."""
    parser = _OneLineParser(prog='tree-sway', description='Trees that sway in measured wind.')
    version = importlib.import_module('tree_sway_ros').__version__
    parser.add_argument('--version', action='version', version=version)
    commands = parser.add_subparsers(dest='command', metavar='COMMAND', required=True)
    for name, (summary, example) in COMMANDS.items():
        sub = commands.add_parser(
            name,
            help=summary,
            description=f'{summary[0].upper()}{summary[1:]}.',
            epilog=f'example: tree-sway {example}',
        )
        sub.add_argument(
            '-q', '--quiet', action='store_true', help='no notes and no progress, errors alone'
        )
        if name == chosen:
            _module(name).add_arguments(sub)
            parser.chosen = sub
    return parser


def _completed() -> str:
    """Command whose arguments the shell wants completed; empty when it wants none."""
    words = os.environ.get('COMP_LINE', '').split() if '_ARGCOMPLETE' in os.environ else []
    return words[1] if len(words) > 1 and words[1] in COMMANDS else ''


def _offer_completion(parser: argparse.ArgumentParser) -> None:
    """Answer the shell that asks for completions, where argcomplete is installed."""
    if '_ARGCOMPLETE' in os.environ:
        with contextlib.suppress(ImportError):
            importlib.import_module('argcomplete').autocomplete(parser)


if __name__ == '__main__':
    sys.exit(main())
