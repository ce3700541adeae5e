# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The contract of imports: packages, layers, no circle, a core without ROS, files or clock."""

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
FILES = sorted(path for package in (LIBRARY, NODES, LAB) for path in package.rglob('*.py'))
#: Whom each package may import of ours, itself included.
PACKAGES = {
    'tree_sway': {'tree_sway'},
    'tree_sway_ros': {'tree_sway', 'tree_sway_ros'},
    'tree_sway_lab': {'tree_sway', 'tree_sway_ros', 'tree_sway_lab'},
}

#: Layer of each room of the library; a room imports only from lower layers and from itself.
LAYERS = {
    'errors': 0, 'tables': 0, 'extras': 1, 'cache': 1, 'worker': 1, 'doorkeeper': 1,
    'installed_models': 2, 'core': 3, 'growth': 4, 'twin': 4, 'simulation': 5, 'files': 6,
    'parameters': 6, 'live': 7, 'stream': 7, 'page': 8, 'pictures': 8, 'commands': 9, 'forest': 10,
}  # fmt: skip
#: Storey of each room of the core: imports point to lower storeys or stay in the room.
STOREYS = {
    'arrays': 0, 'native': 1, 'rotation': 1, 'checks': 1, 'random_source': 1, 'tree': 1,
    'wind': 2, 'oscillators': 2, 'leaves': 3, 'model': 3, 'setup': 4, 'run': 5, 'fidelity': 6,
    'scene': 7,
}  # fmt: skip
CORE_LIBRARIES = {'numpy', 'scipy', 'tree_sway'}
NOT_IN_CORE = {
    'asyncio', 'datetime', 'glob', 'io', 'logging', 'multiprocessing', 'os', 'pathlib', 'random',
    'shutil', 'socket', 'subprocess', 'sys', 'tempfile', 'time', 'urllib',
}  # fmt: skip
#: The same for calls, as numpy's global generator and files need no import. The core starts no
#: thread; locks keep the threads of its callers apart.
NOT_CALLED_IN_CORE = re.compile(
    r'\bnp\.random\.(?!Generator|default_rng\b)|\bdefault_rng\(\s*\)|\bopen\(|\bprint\(|\bThread\('
)


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
            opens_library = path.name == 'library.py' and top in ('pathlib', 'sys')
            if top not in CORE_LIBRARIES and not of_standard and not opens_library:
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
