# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What a package carries: one version, its resources, and executables where ``ros2 run`` looks."""

from __future__ import annotations

import ast
import asyncio
from importlib.metadata import metadata, PackageNotFoundError
import importlib.util
import os
from pathlib import Path
import re
import runpy
import shutil
import signal
import stat
import subprocess
import sys
import tempfile
import time
from typing import Any
from urllib.parse import urljoin
import venv
from xml.etree import ElementTree
import zipfile

import numpy as np
import pytest
import yaml

import tree_sway

ROOT = Path(__file__).resolve().parent.parent
NODES = ('anemometer', 'player', 'sensor', 'solver', 'viewer', 'wind')
IMPORTED = {'yaml': 'python3-yaml'}
LOADED = {'rclpy.lifecycle': 'lifecycle_msgs'}
"""Packages that are loaded where the code has a text, without an import of their own."""


@pytest.fixture(scope='module')
def package() -> ElementTree.Element:
    return ElementTree.parse(ROOT / 'package.xml').getroot()


def test_the_version_is_the_same_everywhere(package: ElementTree.Element) -> None:
    assert package.findtext('version') == tree_sway.__version__
    assert f'\n{tree_sway.__version__} (' in (ROOT / 'CHANGELOG.rst').read_text()


def test_the_package_says_what_ros_asks_for(package: ElementTree.Element) -> None:
    assert package.get('format') == '3'
    assert package.findtext('license') == 'Apache-2.0'
    assert package.findtext('export/build_type') == 'ament_python'
    assert 'Apache License' in (ROOT / 'LICENSE').read_text()


def test_whatever_is_imported_is_depended_on(package: ElementTree.Element) -> None:
    depended = {element.text for element in package.iter('exec_depend')}
    wanted = set()
    for path in [
        p
        for folder in ('tree_sway', 'tree_sway_ros', 'launch')
        for p in (ROOT / folder).rglob('*.py')
    ]:
        for node in ast.walk(ast.parse(path.read_text(encoding='utf-8'))):
            if isinstance(node, ast.ImportFrom):
                wanted.add((node.module or '').split('.')[0])
            elif isinstance(node, ast.Import):
                wanted |= {alias.name.split('.')[0] for alias in node.names}
    wanted -= set(sys.stdlib_module_names) | {'tree_sway', 'tree_sway_ros', '', *OPTIONAL}
    missing = {
        name
        for name in wanted
        if not {name, f'python3-{name}', IMPORTED.get(name, name)} & depended
    }
    assert not missing
    code = ''.join(
        path.read_text()
        for folder in ('tree_sway', 'tree_sway_ros')
        for path in (ROOT / folder).rglob('*.py')
    )
    assert all(text in code for text in LOADED)
    assert not {*LOADED.values()} - depended


#: Asked for by a part that says so when it is missing; they come with an extra, not with rosdep.
OPTIONAL = {
    'PIL',
    'cryptography',
    'dartpy',
    'dask',
    'distributed',
    'imageio_ffmpeg',
    'mpl_toolkits',
    'mpmath',
    'mujoco',
    'netCDF4',
    'openpyxl',
    'pxr',
    'pyarrow',
    'rosbags',
    'sksundae',
}


def test_what_ubuntu_has_no_package_of_is_not_asked_for(package: ElementTree.Element) -> None:
    """Mpmath has no rosdep key on Ubuntu 24.04: rosdep would install nothing."""
    asked = {element.text for element in package if element.tag.endswith('depend')}
    assert not asked & {'python3-mpmath', 'python3-sympy'}


@pytest.fixture(scope='module')
def setup_words() -> dict[str, Any]:
    """Return what setup.py hands to setuptools, run by a link in another folder, as by colcon."""
    setuptools = pytest.importorskip('setuptools', reason='setuptools is not installed here')
    words: dict[str, Any] = {}
    with tempfile.TemporaryDirectory() as folder, pytest.MonkeyPatch.context() as patch:
        link = Path(folder) / 'setup.py'
        link.symlink_to(ROOT / 'setup.py')
        patch.chdir(folder)
        patch.setattr(setuptools, 'setup', lambda **given: words.update(given))
        runpy.run_path(str(link))
    return words


def test_setup_finds_its_files_from_any_folder(setup_words: dict[str, Any]) -> None:
    assert setup_words['version'] == tree_sway.__version__
    assert 'tree_sway.core.run' in setup_words['packages']
    assert setup_words['long_description'].startswith('# ')
    shared = [name for _, names in setup_words['data_files'] for name in names]
    assert {'package.xml', 'launch/sway.launch.py', 'config/solver.yaml'} <= set(shared)


def test_every_file_names_the_same_pythons(setup_words: dict[str, Any]) -> None:
    named = [each.rpartition(' ')[2] for each in setup_words['classifiers']]
    oldest, newest = min(named, key=minor), max(named, key=minor)
    assert setup_words['python_requires'] == f'>={oldest}'
    whole = ', '.join(f'"{each}"' for each in named)
    for file, text in {
        'README.md': f'with Python {oldest}-{newest} ',
        'doc/faq.md': f'**Which Python?** {oldest} to {newest}.',
        'QUALITY_DECLARATION.md': f'Python {oldest} to {newest},',
        'pixi.toml': f'python = ">={oldest},<3.{minor(newest) + 1}"',
        '.github/workflows/checks.yml': f'python: [{whole}]',
        '.github/workflows/release.yml': f'python: ["{oldest}", "{newest}"]',
        '.ci/in_venv.py': f'OLDEST, NEWEST_WITH_ROS = (3, {minor(oldest)}), ',
        'lab/pyproject.toml': f'requires-python = ">={oldest}"',
    }.items():
        if (ROOT / file).is_file():
            assert text in (ROOT / file).read_text(encoding='utf-8'), file


def test_the_newest_python_of_what_is_needed_is_among_them(setup_words: dict[str, Any]) -> None:
    """Of packages that are compiled for each version, and name those that they have wheels for."""
    named = {minor(each.rpartition(' ')[2]) for each in setup_words['classifiers']}
    assert sys.version_info[1] in named
    newest = []
    for package in ('numpy', 'scipy', 'PyYAML'):
        try:
            classifiers = metadata(package).get_all('Classifier') or []
        except PackageNotFoundError:
            continue
        versions = [re.fullmatch(r'Programming Language :: Python :: 3\.(\d+)', each)
                    for each in classifiers]  # fmt: skip
        newest.append(max(int(each[1]) for each in versions if each))
    assert min(newest) <= max(named)


def minor(version: str) -> int:
    return int(version.partition('.')[2])


NO_BUILDER = (
    "No module named 'setuptools'",
    "invalid command 'bdist_wheel'",
    'setuptools.build_meta',
)


def copy_of_source(folder: Path) -> Path:
    """Copy the checkout, so that building leaves nothing behind."""
    ignored = shutil.ignore_patterns('.*', 'build', 'install', 'log', '*.egg-info', '__pycache__')
    return Path(shutil.copytree(ROOT, folder / 'source', ignore=ignored))


@pytest.fixture(scope='module')
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Build the wheel of the checkout, once for all tests of what is in it."""
    folder = tmp_path_factory.mktemp('wheel')
    pip = [sys.executable, '-m', 'pip', '--disable-pip-version-check', 'wheel', '--no-deps']
    pip += ['--quiet', '--no-build-isolation', '-w', str(folder), str(copy_of_source(folder))]
    built = subprocess.run(pip, capture_output=True, text=True, check=False)
    if any(sign in built.stderr for sign in NO_BUILDER):
        pytest.skip('setuptools 70.1 or newer is not installed here, so no wheel can be built')
    assert built.returncode == 0, built.stderr
    (found,) = folder.glob('*.whl')
    return found


def megabytes(folder: Path) -> float:
    """Size of the files of a folder, links counted once [MB]."""
    sizes = {
        (each.st_dev, each.st_ino): each.st_size
        for each in (path.lstat() for path in folder.rglob('*'))
        if stat.S_ISREG(each.st_mode)
    }
    return sum(sizes.values()) / 1e6


def first_picture(line: list[str], folder: Path, environment: dict[str, str]) -> float:
    """Show a tree, open its page, and return the time until its first frame is there [s]."""
    show = [*line, 'show', 'goldcrest', '--seconds', '300', '--port', '0']
    # Where this runs in the background of a shell, Ctrl-C is ignored, and would be by the command.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    began = time.monotonic()
    with subprocess.Popen(
        show, cwd=folder, env=environment, text=True, start_new_session=True,
        stdout=subprocess.PIPE, stderr=subprocess.PIPE,
    ) as process:  # fmt: skip
        assert process.stdout is not None
        found = (re.search(r'open (http://\S+)', text) for text in process.stdout)
        address = next((match[1] for match in found if match), None)
        try:
            if address is not None:
                asyncio.run(first_frame(address))
            spent = time.monotonic() - began
        finally:
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGINT)  # Ctrl-C in a terminal
            signal.signal(signal.SIGINT, before)
        said = process.communicate(timeout=280)[1]
    assert process.returncode == 0, said
    assert address is not None, said
    return spent


async def first_frame(address: str) -> None:
    """Get a page and wait for the first frame of its stream, after the description."""
    aiohttp = pytest.importorskip('aiohttp')
    async with aiohttp.ClientSession() as session:
        async with session.get(address) as page:
            assert '<canvas' in await page.text()
        async with session.ws_connect(urljoin(address, 'stream')) as stream:
            await stream.send_json({'credit': 2})
            message = await asyncio.wait_for(stream.receive(), 60.0)
            while message.type is not aiohttp.WSMsgType.BINARY or message.data[:4] == b'TSWD':
                message = await asyncio.wait_for(stream.receive(), 60.0)
                assert message.type in {aiohttp.WSMsgType.TEXT, aiohttp.WSMsgType.BINARY}


@pytest.mark.long
@pytest.mark.xdist_group('wheel')
@pytest.mark.parametrize('installer', ['pip', 'uvx'])
def test_the_wheel_shows_a_tree_in_a_fresh_environment(
    wheel: Path, tmp_path: Path, installer: str
) -> None:
    """In one line: bars and the page come along, and nothing of the checkout is there."""
    venv.create(tmp_path / 'fresh', with_pip=True)
    programs = tmp_path / 'fresh' / ('Scripts' if os.name == 'nt' else 'bin')
    environment = {**os.environ, 'TREE_SWAY_CACHE': str(tmp_path / 'models')}
    environment['UV_CACHE_DIR'] = str(tmp_path / 'uv')
    line = [str(programs / 'tree-sway')]
    installed = tmp_path / 'fresh'
    install = [str(programs / 'pip'), 'install', '-q', str(wheel)]
    if installer == 'uvx':
        got = subprocess.run([programs / 'pip', 'install', '-q', 'uv'], check=False)
        if got.returncode != 0:
            pytest.skip('uv is not to be had here')
        uvx = [str(programs / 'uvx'), '--python', sys.executable, '--from', str(wheel)]
        line = [*uvx, 'tree-sway']
        installed = tmp_path / 'uv'
        install = [*line, '--version']
    began = time.monotonic()
    got = subprocess.run(install, capture_output=True, text=True, check=False, env=environment)
    seconds = time.monotonic() - began
    if 'error sending request' in got.stderr:
        pytest.skip('uv reaches no package index here')
    assert got.returncode == 0, got.stderr
    first = first_picture(line, tmp_path, environment)
    again = first_picture(line, tmp_path, environment)
    sizes = f'{wheel.stat().st_size / 1e6:.1f} | {seconds:.0f} | {megabytes(installed):.0f}'
    print('\n| way | wheel [MB] | install [s] | environment [MB] | picture [s] | next start [s] |')
    print('|---|---|---|---|---|---|')
    print(f'| {installer} | {sizes} | {first:.1f} | {again:.1f} |')


def test_a_release_is_tested_before_it_is_published_without_a_token() -> None:
    text = (ROOT / '.github' / 'workflows' / 'release.yml').read_text(encoding='utf-8')
    jobs = yaml.safe_load(text)['jobs']
    assert {'fresh', 'uvx'} <= set(jobs['publish']['needs'])
    assert jobs['publish']['permissions'] == {'id-token': 'write'}
    assert jobs['publish']['if'].startswith("startsWith(github.ref, 'refs/tags/v')")
    assert jobs['fresh']['needs'] == 'build'
    systems = {name.split('-')[0] for name in jobs['fresh']['strategy']['matrix']['os']}
    assert systems == {'ubuntu', 'macos', 'windows'}
    assert 'secrets.' not in text
    assert 'password' not in text
    setup = (ROOT / 'setup.py').read_text(encoding='utf-8')
    wheels = re.findall(r"'(\w+)': '\w+-(?:linux|macos|windows)", setup)
    assert len(wheels) == 5
    assert f'for wheel in {" ".join(wheels)}; do' in text


BUILD_NEEDS = """
from setuptools import build_meta
print(build_meta.get_requires_for_build_wheel())
"""


def test_without_a_compiler_one_is_brought_or_named(tmp_path: Path) -> None:
    """Where pip builds apart from what is installed it brings one; elsewhere one line names it."""
    source = copy_of_source(tmp_path)
    hidden = tmp_path / 'hidden'  # Python runs it at its start: ziglang is not found
    hidden.mkdir()
    (hidden / 'sitecustomize.py').write_text("import sys; sys.modules['ziglang'] = None\n")
    environment = {**os.environ, 'PATH': str(tmp_path / 'nothing'), 'PYTHONPATH': str(hidden)}
    environment.pop('CXX', None)
    for path, needed in ((environment['PATH'], True), (os.environ['PATH'], False)):
        done = subprocess.run(
            [sys.executable, '-c', BUILD_NEEDS], cwd=source, env={**environment, 'PATH': path},
            capture_output=True, text=True, check=True,
        )  # fmt: skip
        assert ('ziglang' in done.stdout) is (needed or not shutil.which('c++'))
    done = subprocess.run(
        [sys.executable, 'setup.py', '-q', 'build_ext'], cwd=source, env=environment,
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode != 0
    last = done.stderr.strip().splitlines()[-1]
    assert last.startswith('the native core is not built')
    assert 'apt install g++' in last
    assert 'pip install ziglang' in last


STEPPED = """
import sys
import numpy as np
import tree_sway
from tree_sway.core.native.library import FILE

simulator = tree_sway.make_simulator(tree_sway.open_tree('goldcrest'), model=12)
for _ in range(120):
    simulator.step((6.0, 2.0, 0.0), 1.0 / 60.0)
np.save(sys.argv[1], simulator.place())
print(FILE)
"""


@pytest.mark.long
def test_wheels_that_ziglang_compiles_step_as_here(tmp_path: Path) -> None:
    """One without a system's compiler for this machine, and one for another."""
    source = copy_of_source(tmp_path)
    environment = {**os.environ, 'PATH': str(tmp_path / 'nothing')}
    environment.pop('CXX', None)
    pip = [sys.executable, '-m', 'pip', 'wheel', '-q', '--no-deps', str(source)]
    for wheel in ('', 'manylinux_2_17_aarch64'):
        # The first brings ziglang; the other takes that of this environment, where it is there.
        has_zig = importlib.util.find_spec('ziglang') and importlib.util.find_spec('setuptools')
        own = ['--no-build-isolation'] if wheel and has_zig else []
        got = subprocess.run(
            [*pip, *own, '-w', str(tmp_path / 'wheels')],
            env={**environment, 'TREE_SWAY_WHEEL': wheel},
            capture_output=True, text=True, check=False,
        )  # fmt: skip
        assert got.returncode == 0, got.stderr
        shutil.rmtree(source / 'build')
    (other,) = (tmp_path / 'wheels').glob('*-py3-none-manylinux_2_17_aarch64.whl')
    with zipfile.ZipFile(other) as archive:
        library = archive.read('tree_sway/core/native/_sway.so')
        assert library[:4] == b'\x7fELF'
        assert library[18] == 183  # aarch64
        for name in archive.namelist():
            if name.endswith('/WHEEL'):
                assert b'Root-Is-Purelib: false' in archive.read(name)
    (own,) = set((tmp_path / 'wheels').glob('*.whl')) - {other}
    poses = []
    for folder in (tmp_path / 'installed', ROOT):
        if folder != ROOT:
            zipfile.ZipFile(own).extractall(folder)
        done = subprocess.run(
            [sys.executable, '-c', STEPPED, str(tmp_path / 'poses.npy')], cwd=tmp_path,
            env={**os.environ, 'PYTHONPATH': str(folder), 'TREE_SWAY_CACHE': str(tmp_path / 'c')},
            capture_output=True, text=True, check=True,
        )  # fmt: skip
        assert done.stdout.startswith(str(folder))
        poses.append(np.load(tmp_path / 'poses.npy'))
    np.testing.assert_allclose(poses[0], poses[1], atol=1e-7)


def test_pixi_has_what_setup_asks_for(setup_words: dict[str, Any]) -> None:
    tomllib = pytest.importorskip('tomllib', reason='it came with Python 3.11')
    pixi = tomllib.loads((ROOT / 'pixi.toml').read_text(encoding='utf-8'))
    asked = {re.split('[>=; ]', each)[0].lower() for each in setup_words['install_requires']}
    sensors = {re.split('[>=; ]', each)[0] for each in setup_words['extras_require']['sensors']}
    assert asked | sensors <= set(pixi['dependencies'])
    for distribution in ('jazzy', 'lyrical'):
        feature = pixi['feature'][distribution]
        assert feature['tasks']['demo'] == 'tree-sway demo'
        assert f'ros-{distribution}-rclpy' in feature['dependencies']
        assert pixi['environments'][distribution] == [distribution]


def test_the_recipe_of_conda_has_what_setup_asks_for(setup_words: dict[str, Any]) -> None:
    page = (ROOT / 'doc' / 'releasing.md').read_text(encoding='utf-8')
    blocks = [yaml.safe_load(each) for each in re.findall('```yaml\n(.*?)```', page, re.DOTALL)]
    recipe = next(each for each in blocks if 'requirements' in each)
    listed = {each.replace(' ', '') for each in recipe['requirements']['run']}
    asked = {each.lower() for each in setup_words['install_requires']}
    assert listed - asked == {f'python{setup_words["python_requires"]}'}
    assert asked <= listed


@pytest.mark.long
@pytest.mark.xdist_group('wheel')
def test_a_wheel_brings_executables_to_where_ros2_run_looks(wheel: Path) -> None:
    with zipfile.ZipFile(wheel) as archive:
        infos = {re.sub(r'.*\.data/data/', '', info.filename): info for info in archive.infolist()}
    for node in NODES:
        mode = infos[f'lib/tree_sway_ros/{node}'].external_attr >> 16
        assert mode & 0o111, f'{node} is not executable'
    for name in ('package.xml', 'launch/sway.launch.py'):
        assert f'share/tree_sway_ros/{name}' in infos
    assert 'share/ament_index/resource_index/packages/tree_sway_ros' in infos
    assert not [name for name in infos if name.startswith(('lab/', 'tree_sway_lab'))]
    data = {
        path
        for package in ('tree_sway', 'tree_sway_ros')
        for path in (ROOT / package).rglob('*.*')
        if path.suffix != '.py' and path.is_file() and '__pycache__' not in path.parts
    }
    assert not [path for path in data if str(path.relative_to(ROOT)) not in infos]


def test_colcon_gets_no_second_executables(tmp_path: Path) -> None:
    """What colcon runs is the plain ``install``; setup.cfg sends the scripts to lib/ there."""
    source = copy_of_source(tmp_path)
    installed = tmp_path / 'install'
    command = [sys.executable, 'setup.py', '-q', 'install', '--prefix', str(installed)]
    command += ['--single-version-externally-managed', '--record', str(tmp_path / 'record')]
    # Where scripts go is asked here, not what a compiler makes: `-o FILE` is the end of its words.
    compiler = tmp_path / 'compiler'
    compiler.write_text('#!/bin/sh\nfor file; do :; done\n: >"$file"\n')
    compiler.chmod(0o755)
    result = subprocess.run(
        command, cwd=source, env={**os.environ, 'CXX': str(compiler)},
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    if NO_BUILDER[0] in result.stderr:
        pytest.skip('setuptools is not installed here')
    assert result.returncode == 0, result.stderr
    scripts = {path.name for path in (installed / 'lib' / 'tree_sway_ros').iterdir()}
    assert scripts == {*NODES, 'tree-sway'}
    first = (installed / 'lib' / 'tree_sway_ros' / 'solver').read_text().split('\n')[0]
    assert first == '#!/usr/bin/env python3'  # so that an activated environment is heeded


@pytest.mark.long
def test_colcon_builds_the_package_without_the_laboratory(tmp_path: Path) -> None:
    """As in a workspace: colcon of the package index builds what ``ros2 run`` starts."""
    source = copy_of_source(tmp_path)
    venv.create(tmp_path / 'venv', with_pip=True)
    programs = tmp_path / 'venv' / 'bin'
    tools = ('colcon-core', 'colcon-ros', 'setuptools<80')
    subprocess.run([programs / 'pip', 'install', '-q', *tools], check=True)
    build = [programs / 'colcon', 'build', '--base-paths', str(source)]
    path = f'{programs}{os.pathsep}{os.environ["PATH"]}'
    subprocess.run(build, cwd=tmp_path, check=True, env={**os.environ, 'PATH': path})
    installed = tmp_path / 'install' / 'tree_sway_ros'
    assert {path.name for path in (installed / 'lib/tree_sway_ros').iterdir()} == {
        *NODES,
        'tree-sway',
    }
    assert (installed / 'share/tree_sway_ros/package.xml').exists()
    assert not list(installed.rglob('tree_sway_lab'))
