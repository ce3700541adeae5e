# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The contract of imports: packages, layers, no circle, a core without ROS, files or clock."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from functools import cache
from importlib import import_module
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

#: Storey of each house and of each module that is a house of its own: who stands outside enters
#: by the face, from a higher storey. Houses of the library first, then those of the core, then
#: the commands that houses bring.
STOREYS = {
    'errors': 0, 'faces': 0, 'tables': 0, 'drawn': 0, 'by_name': 26, 'extras': 1, 'cache': 1,
    'worker': 1, 'newest': 1, '__main__': 40,
    'doorkeeper': 1, 'installed_models': 2, 'commands': 19, 'core': 20, 'growth': 21,
    'identification': 21, 'twin': 21, 'fidelity': 21,
    'simulation': 22, 'files': 23, 'parameters': 23, 'live': 24, 'stream': 24, 'page': 25,
    'pictures': 25, 'forest': 25,
    'core.arrays': 3, 'core.rotation': 4, 'core.checks': 4, 'core.random_source': 4,
    'core.native': 4, 'core.drag': 5, 'core.species': 5, 'core.tree': 6, 'core.wind': 7,
    'core.oscillators': 7, 'core.leaves': 8, 'core.settings': 8, 'core.tree_state': 7,
    'core.model': 9, 'core.setup': 10, 'core.run': 11, 'core.scene': 13,
    'files.commands': 30, 'growth.commands': 31, 'identification.commands': 31,
    'live.commands': 31, 'page.commands': 32,
    'twin.commands': 33, 'simulation.commands': 34, 'pictures.commands': 35, 'forest.commands': 35,
}  # fmt: skip
#: Rooms with a face of their own.
WINGS = {
    'core.wind.gusts', 'simulation.wind', 'files.export', 'files.models', 'files.motion',
    'files.recording', 'files.scenes', 'files.trees', 'files.wind', 'twin.camera',
}  # fmt: skip
LARGEST_FACE = 25
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


def house_of(module: str) -> str:
    """House of a module of the library; empty for the package's root and for other packages."""
    top, _, rest = module.partition('.')
    parts = rest.split('.')
    is_deeper = parts[0] == 'core' or parts[1:2] == ['commands']
    return '.'.join(parts[: 1 + is_deeper]) if top == 'tree_sway' else ''


def faces() -> dict[str, list[str]]:
    """Names on the face of each house and wing."""
    found = {}
    for path in LIBRARY.rglob('__init__.py'):
        module = name_of(path)
        if (room := module.partition('.')[2]) in STOREYS | dict.fromkeys(WINGS) and room != 'core':
            found[module] = [
                alias.name
                for node in import_nodes(path)
                if node.col_offset
                for alias in node.names
            ]
    return found


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


def test_every_house_has_a_storey() -> None:
    houses = {house_of(name_of(path)) for path in LIBRARY.rglob('*.py')} - {''}
    assert houses == set(STOREYS)


def test_a_house_is_entered_by_its_face() -> None:
    """
    From outside, nothing is imported from a module within; a module alone is its own face.

    The commands that a house brings belong to it: they may import its modules.
    """
    wrong = []
    for path in FILES:
        own = house_of(name_of(path))
        for node in import_nodes(path):
            for alias in node.names:
                module = node.module if isinstance(node, ast.ImportFrom) else alias.name
                house = house_of(module or '')
                room = (module or '').partition('.')[2]
                is_within = f'{module}.{alias.name}' in MODULES and house != 'core'
                is_outside = house not in (own, own.removesuffix('.commands'))
                if house and is_outside and (is_within or room not in {house, *WINGS}):
                    wrong.append(f'{path}:{node.lineno} imports {alias.name} past the face')
    assert not wrong, '\n'.join(wrong)


def test_the_laboratory_enters_the_nodes_by_the_faces_of_their_rooms() -> None:
    wrong = [
        f'{path}:{line} imports {module}'
        for path in LAB.rglob('*.py')
        for line, module, _ in imports_of(path)
        if module.startswith('tree_sway_ros.')
        and module.count('.') > 1
        and 'commands' not in module
    ]
    assert not wrong, '\n'.join(wrong)


def test_nodes_know_no_annex_by_name() -> None:
    """Those of the solver register by entry points; the folder of one may be taken away."""
    wrong = [
        f'{path}:{line} imports {module}'
        for path in NODES.rglob('*.py')
        for line, module, _ in imports_of(path)
        if path.parent != NODES / 'motion'
        and module.startswith(('tree_sway.twin', 'tree_sway_ros.motion'))
    ]
    assert not wrong, '\n'.join(wrong)


def test_a_face_is_small_and_every_name_on_it_is_there() -> None:
    wrong = []
    for module, names in faces().items():
        face = import_module(module)
        assert face.__doc__
        if len(names) > LARGEST_FACE:
            wrong.append(f'{module} offers {len(names)} names')
        wrong += [f'{module} lacks {name}' for name in names if not hasattr(face, name)]
        wrong += [
            f'{module}.{name} is a module too' for name in names if f'{module}.{name}' in MODULES
        ]
    assert not wrong, '\n'.join(wrong)


def test_a_name_that_a_face_does_not_offer_is_refused() -> None:
    with pytest.raises(AttributeError, match=r"'tree_sway\.core\.tree' has no attribute 'Shrub'"):
        import_module('tree_sway.core.tree').Shrub  # noqa: B018


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
        own = house_of(name_of(path))
        for line, module, _ in imports_of(path):
            other = house_of(module)
            if own and other and other != own and STOREYS[other] >= STOREYS[own]:
                wrong.append(f'{path}:{line}: {own} imports {module}')
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
    """A name of a face is one of the module that it is in."""
    homes = {
        (name_of(path), alias.name): node.module
        for path in FILES
        if path.name == '__init__.py'
        for node in import_nodes(path)
        if node.col_offset and isinstance(node, ast.ImportFrom)
        for alias in node.names
    }
    graph = {
        name_of(path): {
            home if (home := homes.get((module, alias.name))) else module
            for _, module, node in imports_of(path)
            for alias in node.names
            if module in MODULES and not (node.col_offset and path.name == '__init__.py')
        }
        for path in FILES
    }
    done: set[str] = set()

    def visit(module: str, trail: tuple[str, ...]) -> None:
        assert module not in trail, ' -> '.join((*trail[trail.index(module) :], module))
        if module not in done:
            for other in sorted(graph[module]):
                visit(other, (*trail, module))
            done.add(module)

    for module in graph:
        visit(module, ())
