# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The contract of the code's layout: layers, sizes, names, docstrings; read from the source."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from functools import cache
from pathlib import Path
import re
import sys

import pytest

ROOT = Path(__file__).resolve().parent.parent
LIBRARY, NODES, LAB = (ROOT / name for name in ('tree_sway', 'tree_sway_ros', 'lab/tree_sway_lab'))
PRODUCT = sorted(path for package in (LIBRARY, NODES) for path in package.rglob('*.py'))
FILES = sorted([*PRODUCT, *LAB.rglob('*.py')])
TEST_FILES = sorted([*(ROOT / 'test').rglob('*.py'), *(ROOT / 'lab' / 'test').rglob('*.py')])
#: Whom each package may import of ours, itself included.
PACKAGES = {
    'tree_sway': {'tree_sway'},
    'tree_sway_ros': {'tree_sway', 'tree_sway_ros'},
    'tree_sway_lab': {'tree_sway', 'tree_sway_ros', 'tree_sway_lab'},
}

#: Layer of each room of the library; a room imports only from lower layers and from itself.
LAYERS = {
    'errors': 0, 'tables': 0, 'kernel_folder': 0, 'extras': 0.2, 'kernel_cache': 0.5,
    'set_up_files': 0.7, 'core': 1, 'files': 2, 'parameters': 2.5,
    'page': 3, 'pictures': 3, 'studies': 5, 'commands': 4,
}  # fmt: skip
#: Storey of each room of the core: imports point to lower storeys or stay in the room.
STOREYS = {
    'arrays': 0, 'kernel': 1, 'checks': 1, 'tree': 1,
    'rotation': 2, 'wind': 2, 'branch': 2, 'oscillators': 2,
    'growth': 3, 'leaves': 3, 'reduction': 3,
    'motion': 4,
    'reference': 5, 'state': 5,
    'simulator': 6,
    'fidelity': 7, 'identification': 7, 'strength': 7,
    'scene': 8,
}  # fmt: skip
#: Most files in one folder.
MAX_FILES = 20
CORE_LIBRARIES = {'numpy', 'scipy', 'numba', 'tree_sway'}
NOT_IN_CORE = {
    *(
        'asyncio',
        'datetime',
        'glob',
        'io',
        'logging',
        'multiprocessing',
        'os',
        'pathlib',
        'random',
    ),
    *('shutil', 'socket', 'subprocess', 'sys', 'tempfile', 'threading', 'time', 'urllib'),
}
#: The same for calls, as numpy's global generator and files need no import.
NOT_CALLED_IN_CORE = re.compile(
    r'\bnp\.random\.(?!Generator|default_rng\b)|\bdefault_rng\(\s*\)|\bopen\(|\bprint\('
)
BANNED_NAMES = {'utils', 'util', 'helpers', 'helper', 'common', 'manager', 'misc', 'tools_common'}


def name_of(path: Path) -> str:
    """Dotted name of a module."""
    parts = path.relative_to(ROOT).with_suffix('').parts
    parts = parts[1:] if parts[0] == 'lab' else parts
    return '.'.join(parts[:-1] if parts[-1] == '__init__' else parts)


def room_of(module: str) -> str:
    """Room of a module of ours: the name below the package; empty for the package's root."""
    return module.split('.')[1] if '.' in module else ''


@cache
def import_nodes(path: Path) -> list[ast.Import | ast.ImportFrom]:
    """Return the import statements of a file."""
    nodes = ast.walk(ast.parse(path.read_text(encoding='utf-8')))
    return [node for node in nodes if isinstance(node, ast.Import | ast.ImportFrom)]


def imports_of(path: Path) -> Iterator[tuple[int, str, ast.AST]]:
    """Each imported module with its line; names that are modules themselves are written out."""
    for node in import_nodes(path):
        if isinstance(node, ast.Import):
            for alias in node.names:
                yield node.lineno, alias.name, node
        elif not node.level:
            assert node.module is not None
            for alias in node.names:
                inner = f'{node.module}.{alias.name}'
                yield node.lineno, inner if inner in MODULES else node.module, node


MODULES = {name_of(path) for path in FILES}


def test_every_room_has_a_layer() -> None:
    rooms = {room_of(name_of(path)) for path in LIBRARY.rglob('*.py')} - {''}
    assert rooms == set(LAYERS)


def test_a_package_imports_none_above_it() -> None:
    wrong = [
        f'{path}:{line} imports {module}'
        for path in FILES
        for line, module, _ in imports_of(path)
        if (top := module.split('.')[0]) in PACKAGES
        and top not in PACKAGES[name_of(path).split('.')[0]]
    ]
    assert not wrong, '\n'.join(wrong)


def test_imports_are_absolute_and_never_from_the_package_root() -> None:
    wrong = []
    for path in FILES:
        for node in import_nodes(path):
            if isinstance(node, ast.ImportFrom) and node.level:
                wrong.append(f'{path}:{node.lineno} is relative')
        for line, module, _ in imports_of(path):
            if module in PACKAGES and path.parent != LAB:
                wrong.append(f'{path}:{line} imports from the package root')
    assert not wrong, '\n'.join(wrong)


def test_imports_point_down() -> None:
    wrong = []
    for path in sorted(LIBRARY.rglob('*.py')):
        room = room_of(name_of(path))
        for line, module, _ in imports_of(path):
            if module.split('.')[0] != 'tree_sway' or not room:
                continue
            other = room_of(module)
            if other != room and LAYERS[other] >= LAYERS[room]:
                wrong.append(f'{path}:{line}: {room} imports {module}')
    assert not wrong, '\n'.join(wrong)


def test_core_knows_no_ros_no_files_no_clock() -> None:
    wrong = []
    for path in (LIBRARY / 'core').rglob('*.py'):
        for line, module, _ in imports_of(path):
            top = module.split('.')[0]
            of_standard = top in sys.stdlib_module_names and top not in NOT_IN_CORE
            if top not in CORE_LIBRARIES and not of_standard:
                wrong.append(f'{path}:{line} imports {module}')
        for number, text in enumerate(path.read_text(encoding='utf-8').splitlines(), 1):
            if NOT_CALLED_IN_CORE.search(text.split('#')[0]):
                wrong.append(f'{path}:{number} has {text.strip()}')
    assert not wrong, '\n'.join(wrong)


@pytest.mark.parametrize('text', ['np.random.rand(3)', 'default_rng()', "open('x')", 'print(1)'])
def test_the_core_check_sees_what_it_looks_for(text: str) -> None:
    assert NOT_CALLED_IN_CORE.search(text)
    assert not NOT_CALLED_IN_CORE.search('np.random.Generator, rng.normal(), fingerprint (1)')


def test_no_import_cycle() -> None:
    graph = {name_of(path): {m for _, m, _ in imports_of(path) if m in MODULES} for path in FILES}
    done: set[str] = set()

    def visit(module: str, trail: tuple[str, ...]) -> None:
        assert module not in trail, ' -> '.join((*trail[trail.index(module) :], module))
        if module not in done:
            for other in sorted(graph[module]):
                visit(other, (*trail, module))
            done.add(module)

    for module in graph:
        visit(module, ())


def test_rooms_of_the_core_have_an_order() -> None:
    wrong = []
    for path in sorted((LIBRARY / 'core').rglob('*.py')):
        parts = name_of(path).split('.')
        if len(parts) < 3:
            continue
        own = parts[2]
        assert own in STOREYS, f'{own} has no storey'
        for line, module, _ in imports_of(path):
            if not module.startswith('tree_sway.core.'):
                continue
            other = module.split('.')[2]
            if other != own and STOREYS[other] >= STOREYS[own]:
                wrong.append(f'{path}:{line}: {own} imports {module}')
    assert not wrong, '\n'.join(wrong)


def test_no_folder_is_an_alphabet() -> None:
    folders = {path.parent for path in FILES}
    counts = {f: sum(p.stem != '__init__' for p in f.glob('*.py')) for f in folders}
    assert not {str(f): n for f, n in counts.items() if n > MAX_FILES}


def test_every_room_says_what_lives_in_it() -> None:
    mute = [
        str(path)
        for path in FILES
        if path.stem == '__init__'
        and path.parent not in (LIBRARY, NODES)
        and len((ast.get_docstring(ast.parse(path.read_text('utf-8'))) or '').splitlines()) < 2
    ]
    assert not mute, '\n'.join(mute)


def test_names_say_what_is_inside() -> None:
    stems = {path.stem for path in [*FILES, *(p.parent for p in FILES)]}
    assert not stems & BANNED_NAMES
    of_standard = (stems & set(sys.stdlib_module_names)) - {'__init__', 'calibrate'}
    assert not of_standard, f'named like a module of the standard library: {of_standard}'


def public_definitions(tree: ast.Module) -> Iterator[tuple[str, ast.AST]]:
    """Public classes and functions of a module, and the public methods of the classes."""
    for node in tree.body:
        if not isinstance(node, ast.FunctionDef | ast.ClassDef) or node.name.startswith('_'):
            continue
        yield node.name, node
        if isinstance(node, ast.ClassDef):
            for inner in node.body:
                if isinstance(inner, ast.FunctionDef) and not inner.name.startswith('_'):
                    yield f'{node.name}.{inner.name}', inner


def docstring_faults(source: str) -> Iterator[tuple[int, str]]:
    """Public definitions without a docstring, or with one of another form than ours."""
    tree = ast.parse(source)
    if not ast.get_docstring(tree):
        yield 1, 'the module has no docstring'
    for name, node in public_definitions(tree):
        assert isinstance(node, ast.FunctionDef | ast.ClassDef)
        raw = ast.get_docstring(node, clean=False)
        if raw is None:
            yield node.lineno, f'{name} has no docstring'
        elif '\n' in raw.strip():
            if raw.split('\n')[0].strip():
                yield node.lineno, f'{name}: the summary is on the second line'
            elif re.search(r'^ *---+$', raw, re.MULTILINE) and not raw.rstrip(' ').endswith(
                '\n\n'
            ):
                yield node.lineno, f'{name}: a blank line ends the last section'
            for section in re.findall(r'^ *(Args|Arguments|Params):\s*$', raw, re.MULTILINE):
                yield node.lineno, f"{name}: '{section}:' is not NumPy style"


@pytest.mark.parametrize('path', FILES, ids=lambda path: str(path.relative_to(ROOT)))
def test_docstrings(path: Path) -> None:
    faults = [
        f'{path}:{line}: {fault}' for line, fault in docstring_faults(path.read_text('utf-8'))
    ]
    assert not faults, '\n'.join(faults)


def test_the_docstring_check_sees_what_it_looks_for() -> None:
    source = '''"""M."""
def bare(): pass
def google():
    """
    Do.

    Args:
        x: thing

    """
def tight():
    """
    Do.

    Raises
    ------
    ValueError
    """
def short():
    """
    Do.

    More.
    """
def first_line():
    """Do.

    More.

    """
'''
    assert [fault.split(' ')[0].rstrip(':') for _, fault in docstring_faults(source)] == [
        *('bare', 'google', 'tight', 'first_line')
    ]
