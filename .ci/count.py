#!/usr/bin/env python3
# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Count the code: tokens, tokens per line, short names, public names, modules that a step loads.

    python3 .ci/count.py
    python3 .ci/count.py --names tree_sway/core/run --modules

Counted are Python's tokens without comments, docstrings, imports and line ends; a line counts if a
counted token begins on it. A room is a folder with modules; its figures are those of its own
modules, without those of the folders in it. The modules of a step are found by running simulators
of the built-in benjamina in other processes, where opening the tree has loaded nothing: one that
prepares its model, and one whose model is read from a file. They are run by the Python of the
checkout's `.venv` or by the one that runs this script; without numpy that part is left out. A
module runs in a step if Python calls one of its functions then. Of C++ and JavaScript the names,
numbers, texts and signs are counted, without comments.

"""

from __future__ import annotations

import argparse
import ast
from collections.abc import Iterator
from dataclasses import dataclass
import io
from pathlib import Path
import re
import subprocess
import sys
import tempfile
import tokenize

ROOT = Path(__file__).resolve().parent.parent
LIBRARY, NODES = 'tree_sway', 'tree_sway_ros'
NAMED = 'tree_sway/core/run'
"""Folder whose short names are counted by default, if it is there; all folders are listed."""

LAYOUT = {
    tokenize.COMMENT,
    tokenize.NL,
    tokenize.NEWLINE,
    tokenize.INDENT,
    tokenize.DEDENT,
    tokenize.ENCODING,
    tokenize.ENDMARKER,
}
"""Kinds of tokens that are not counted."""

FOREIGN = (
    ('the native core, C++', 'native', {'.cpp', '.h', '.inc'}),
    ('the page, JavaScript', 'tree_sway/page/static', {'.js'}),
)
"""What is written in other languages: name, folder, suffixes."""

_FOREIGN_COMMENT = re.compile(r'/\*.*?\*/|(?<!:)//[^\n]*', re.DOTALL)
_FOREIGN_TOKEN = re.compile(
    r'"[^"\n]*"|\'[^\'\n]*\'|`[^`]*`|\w+(?:\.\d+)?|<<|>>|->|=>|::|[-+*/<>=!&|]=+|&&|\|\||[^\w\s]'
)

SIMULATORS = (
    ('tree_sway/core/run/simulator.py', 'SwaySimulator'),
    ('tree_sway/core/scene/scene_simulator.py', 'SceneSimulator'),
)
"""Simulators of one tree and of many: their public names are compared, if both are there."""

SHORT = 2
"""Most letters of a short name."""

OPENING = """
import pickle
import sys
import tree_sway

tree = tree_sway.open_tree('benjamina').tree
with open(sys.argv[1] + '/tree', 'wb') as file:
    pickle.dump(tree, file)
tree_sway.write_model(sys.argv[1] + '/model.npz', tree_sway.prepare(tree, cache=None))
"""
"""Program that writes a built-in tree and its model to a folder."""

STEPPING = """
import pickle
import sys
import tree_sway

if sys.argv[1].endswith('.npz'):
    tree = tree_sway.read_model(sys.argv[1])
else:
    with open(sys.argv[1], 'rb') as file:
        tree = pickle.load(file)
simulator = tree_sway.make_simulator(tree, cache=None)
simulator.step((5.0, 0.0, 0.0), 1 / 60)
simulator.place()
modules = {n: m for n, m in sys.modules.items() if n.partition('.')[0] == 'tree_sway'}

ran = set()


def note(frame, event, argument):
    if event == 'call' and frame.f_globals.get('__name__') in modules:
        ran.add(frame.f_globals['__name__'])


sys.setprofile(note)
for _ in range(3):
    simulator.step((6.0, 1.0, 0.0), 1 / 60)
    simulator.place()
sys.setprofile(None)

for name, module in sorted(modules.items()):
    if getattr(module, '__file__', None):
        print(int(name in ran), module.__file__)
"""
"""Program that prints the modules that a simulator of one of them loads; 1: those that run."""


@dataclass
class Count:
    """Sums over some modules."""

    modules: int = 0
    tokens: int = 0
    lines: int = 0
    public: int = 0
    assigned: int = 0
    short: int = 0

    def __add__(self, other: Count) -> Count:
        """Add up two counts."""
        both = zip(vars(self).values(), vars(other).values(), strict=True)
        return Count(*(one + two for one, two in both))

    @property
    def per_line(self) -> float:
        """Tokens per line of code."""
        return self.tokens / max(self.lines, 1)

    @property
    def short_share(self) -> float:
        """Share of short names among all names that are assigned, each time that one is."""
        return self.short / max(self.assigned, 1)


def left_out(module: ast.Module) -> set[int]:
    """Return the lines of docstrings and imports."""
    lines: set[int] = set()
    for node in ast.walk(module):
        if isinstance(node, ast.Import | ast.ImportFrom) or is_docstring(node):
            assert isinstance(node, ast.stmt)
            lines.update(range(node.lineno, (node.end_lineno or node.lineno) + 1))
    return lines


def is_docstring(node: ast.AST) -> bool:
    """Whether a statement is a string alone: a docstring of a module, function, class or name."""
    return (
        isinstance(node, ast.Expr)
        and isinstance(node.value, ast.Constant)
        and isinstance(node.value.value, str)
    )


def public_names(module: ast.Module) -> Iterator[str]:
    """Yield the names that a module defines without an underscore, and those of its classes."""
    for node in module.body:
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
            if node.name.startswith('_'):
                continue
            yield node.name
            for inner in node.body if isinstance(node, ast.ClassDef) else []:
                is_function = isinstance(inner, ast.FunctionDef | ast.AsyncFunctionDef)
                if is_function and not inner.name.startswith('_'):
                    yield f'{node.name}.{inner.name}'
        elif isinstance(node, ast.Assign | ast.AnnAssign):
            for target in node.targets if isinstance(node, ast.Assign) else [node.target]:
                for name in ast.walk(target):
                    if isinstance(name, ast.Name) and not name.id.startswith('_'):
                        yield name.id


def names_of_class(path: Path, name: str) -> set[str] | None:
    """Return the public names of the instances of a class; None if it is not there."""
    if not path.is_file():
        return None
    for node in ast.parse(path.read_text(encoding='utf-8')).body:
        if isinstance(node, ast.ClassDef) and node.name == name:
            functions = {each.name for each in node.body if isinstance(each, ast.FunctionDef)}
            set_on_self = {
                each.attr
                for each in ast.walk(node)
                if isinstance(each, ast.Attribute)
                and isinstance(each.ctx, ast.Store)
                and isinstance(each.value, ast.Name)
                and each.value.id == 'self'
            }
            return {each for each in functions | set_on_self if not each.startswith('_')}
    return None


def count_of(path: Path) -> Count:
    """Count one module."""
    source = path.read_text(encoding='utf-8')
    module = ast.parse(source)
    skipped = left_out(module)
    starts = [
        token.start[0]
        for token in tokenize.generate_tokens(io.StringIO(source).readline)
        if token.type not in LAYOUT and token.start[0] not in skipped
    ]
    assigned = [
        node.id
        for node in ast.walk(module)
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)
    ]
    return Count(
        modules=int(bool(starts)),
        tokens=len(starts),
        lines=len(set(starts)),
        public=len(set(public_names(module))),
        assigned=len(assigned),
        short=sum(len(name) <= SHORT for name in assigned),
    )


def foreign_tokens(path: Path) -> int:
    """Count the tokens of a file of C++ or JavaScript."""
    code = _FOREIGN_COMMENT.sub('', path.read_text(encoding='utf-8'))
    return len(_FOREIGN_TOKEN.findall(code))


def total(counts: dict[Path, Count], folder: Path) -> Count:
    """Sum up all modules below a folder."""
    return sum((one for path, one in counts.items() if folder in path.parents), Count())


def interpreter() -> str:
    """Return the Python of the checkout's environment; this one if there is none."""
    own = ROOT / '.venv' / 'bin' / 'python'
    return str(own) if own.is_file() else sys.executable


def modules_of_a_step() -> list[dict[Path, bool]]:
    """
    Return modules that a simulator loads, and whether each runs in a step; none on failure.

    The first are those of a simulator that prepares its model, the second those of one that is
    given a model of a file.
    """
    printed = []
    with tempfile.TemporaryDirectory() as folder:
        runs = ((OPENING, folder), (STEPPING, f'{folder}/tree'), (STEPPING, f'{folder}/model.npz'))
        for program, argument in runs:
            command = [interpreter(), '-c', program, argument]
            done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
            if done.returncode:
                reason = done.stderr.strip().splitlines() or ['no reason given']
                print(reason[-1], file=sys.stderr)
                return []
            printed.append([line.split(' ', 1) for line in done.stdout.splitlines()])
    return [{Path(path).resolve(): ran == '1' for ran, path in lines} for lines in printed[1:]]


def offered() -> int:
    """Return how many names `import tree_sway` offers: `__all__`, or its table of names."""
    program = f'import {LIBRARY}; print(len({LIBRARY}.__all__))'
    done = subprocess.run(
        [sys.executable, '-c', program], cwd=ROOT, capture_output=True, text=True
    )
    return int(done.stdout or 0)


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=(__doc__ or '').strip().splitlines()[0])
    parser.add_argument('--names', metavar='FOLDER', default=NAMED, help=NAMED)
    parser.add_argument('--modules', action='store_true', help='list the modules of a step')
    arguments = parser.parse_args()
    counts = {
        path: count_of(path)
        for package in (LIBRARY, NODES)
        for path in sorted((ROOT / package).rglob('*.py'))
    }
    library, nodes = (total(counts, ROOT / package) for package in (LIBRARY, NODES))
    core = total(counts, ROOT / LIBRARY / 'core')
    rooms: dict[str, Count] = {}
    for path, one in counts.items():
        room = path.parent.relative_to(ROOT).as_posix()
        rooms[room] = rooms.get(room, Count()) + one
    largest = max(
        (room for room in rooms if not room.startswith(NODES)), key=lambda r: rooms[r].tokens
    )
    densest = max(
        (room for room in rooms if rooms[room].lines >= 100), key=lambda r: rooms[r].per_line
    )

    def row(name: str, value: str) -> None:
        print(f'{name:<58} {value:>12}')

    row('tokens of library and nodes', f'{library.tokens + nodes.tokens:,}')
    row('  of the library', f'{library.tokens:,}')
    row('  of the nodes', f'{nodes.tokens:,}')
    for name, folder, suffixes in FOREIGN:
        paths = (path for path in (ROOT / folder).rglob('*') if path.suffix in suffixes)
        row(f'tokens of {name}', f'{sum(map(foreign_tokens, paths)):,}')
    row('lines of library and nodes', f'{library.lines + nodes.lines:,}')
    row('tokens per line, library and nodes', f'{(library + nodes).per_line:.1f}')
    row('tokens per line, core', f'{core.per_line:.1f}')
    row(f'tokens per line, densest room of 100 lines: {densest}', f'{rooms[densest].per_line:.1f}')
    share = rooms[largest].tokens / library.tokens
    row(f'share of the largest room in the library: {largest}', f'{share:.1%}')
    row('names that `import tree_sway` offers', f'{offered()}')
    one, many = (names_of_class(ROOT / path, name) for path, name in SIMULATORS)
    if one is not None and many is not None:
        row('public names that a simulator of one or of many lacks', f'{len(one ^ many)}')
    row('public names that library and nodes define', f'{library.public + nodes.public:,}')
    folder = ROOT / arguments.names
    if folder.is_dir():
        row(
            f'names of 1 or 2 letters, {arguments.names}',
            f'{total(counts, folder).short_share:.0%}',
        )
    stepping = modules_of_a_step()
    if not stepping:
        row('modules of a stepping simulator', 'not counted')
    else:
        prepared, stored = (
            {path for path in each if counts.get(path, Count()).modules} for each in stepping
        )
        ran = {path for path in prepared if stepping[0][path]}
        for words, paths in (
            ('loaded by a simulator, its set-up included', prepared),
            ('loaded by a simulator of a model in a file', stored),
            ('that run in a step', ran),
        ):
            row(f'modules {words}', f'{len(paths)}')
            row('  their tokens', f'{sum(counts[path].tokens for path in paths):,}')
        if arguments.modules:
            for path in sorted(prepared | stored):
                mark = 'runs' if path in ran else 'stored' if path in stored else 'set-up'
                print(f'  {mark:<7} {path.relative_to(ROOT)} {counts[path].tokens}')

    print(f'\n{"room":<36} {"modules":>7} {"tokens":>8} {"lines":>6} {"a line":>6} {"short":>6}')
    for room, one in sorted(rooms.items()):
        if one.tokens:
            figures = f'{one.modules:>7} {one.tokens:>8,} {one.lines:>6,} {one.per_line:>6.1f}'
            print(f'{room:<36} {figures} {one.short_share:>6.0%}')


if __name__ == '__main__':
    main()
