"""
The command line ``tree-sway``: one module a command, imported when it is asked for.

A module of a command has ``add_arguments(parser)`` and ``run(arguments) -> int``. Whatever the user
can mend ends as one line on standard error and exit code 2.

"""

from __future__ import annotations

import argparse
import importlib
import io
import os
import sys
from collections.abc import Sequence
from typing import Any, NoReturn

from tree_sway_ros.errors import TreeSwayError

COMMANDS: dict[str, str] = {
    "demo": "a tree sways in wind, all nodes in one process over real DDS",
    "listen": "count the poses that a solver in another process streams",
    "info": "what a tree is: size, masses, natural frequencies",
    "plot": "pictures of a tree, and of the wind and the motion of its tip",
    "grow": "make a tree of a species and a height",
    "convert": "write a tree in another format",
    "calibrate": "fit modulus and damping to one measured sway",
    "bench": "time the solver",
    "battery": "the cases where methods of integration fail, and what ours does there",
    "chart": "speed against accuracy: of methods, of models, against size",
    "compare": "our simulator against MuJoCo, in one run",
    "paper": "the experiment of Kanda & Ohya as it is written, and what ours does instead",
    "docs": "write the tables of topics and parameters into the README",
}

#: Commands of the study, which nothing that runs imports; each is a module ``command`` of its room.
_STUDIES = ("bench", "battery", "chart", "compare", "paper")
_FAILURE = 2
_INTERRUPTED = 130


class _OneLineParser(argparse.ArgumentParser):
    """Errors on one line, without the usage before it."""

    def error(self, message: str) -> NoReturn:
        """Print what is wrong and where to read more, and exit."""
        print(f"{self.prog}: {message}; see {self.prog} --help", file=sys.stderr)
        raise SystemExit(_FAILURE)


def main(argv: Sequence[str] | None = None) -> int:
    """
    Run a command.

    Parameters
    ----------
    argv
        Arguments without the program's name; `sys.argv` if None.

    Returns
    -------
    int
        Exit code: 0, or 2 if the user can mend it, with one line that says how.

    """
    given = list(sys.argv[1:] if argv is None else argv)
    command = given[0] if given else ""
    if isinstance(sys.stdout, io.TextIOWrapper):  # names that the terminal cannot show are escaped
        sys.stdout.reconfigure(errors="backslashreplace")
    try:
        arguments = _parser(command).parse_args(given)
        module = _module(arguments.command)
        return int(module.run(arguments))
    except TreeSwayError as error:
        return _fail(command, str(error))
    except ModuleNotFoundError as error:
        if str(error.name).startswith("tree_sway_ros"):
            raise
        return _fail(command, f"{error}; install the package with its dependencies (README)")
    except BrokenPipeError:
        # Whoever read our output has gone; keep Python from complaining when it flushes.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except OSError as error:
        return _fail(
            command, f"{error.filename}: {error.strerror}" if error.filename else str(error)
        )
    except KeyboardInterrupt:
        return _INTERRUPTED


def _fail(command: str, text: str) -> int:
    print(f"tree-sway {command}: {' '.join(text.split())}", file=sys.stderr)
    return _FAILURE


def _module(command: str) -> Any:
    where = f"study.{command}.command" if command in _STUDIES else f"tools.{command}"
    return importlib.import_module(f"tree_sway_ros.{where}")


def _parser(chosen: str) -> argparse.ArgumentParser:
    """
    Parser of all commands; only the chosen one's arguments, as the others' modules may be slow.

    """
    parser = _OneLineParser(prog="tree-sway", description="Trees that sway in measured wind.")
    version = importlib.import_module("tree_sway_ros").__version__
    parser.add_argument("--version", action="version", version=version)
    commands = parser.add_subparsers(dest="command", metavar="COMMAND", required=True)
    for name, summary in COMMANDS.items():
        sub = commands.add_parser(name, help=summary, description=summary.capitalize() + ".")
        if name == chosen:
            _module(name).add_arguments(sub)
    return parser


if __name__ == "__main__":
    sys.exit(main())
