# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Build tree_sway_ros: under colcon as an ament_python package, under pip as a wheel."""

from importlib.util import find_spec
import os
from pathlib import Path
import platform
import re
import shutil
import sys

from setuptools import Extension, find_packages, setup
from setuptools.command.build_ext import build_ext
from setuptools.errors import CompileError, LinkError

try:
    from setuptools.command.bdist_wheel import bdist_wheel
except ImportError:  # an older setuptools, which builds no wheel of this package
    bdist_wheel = None

PACKAGE = 'tree_sway_ros'
LIBRARY = 'tree_sway'
#: The folder of this file; `colcon build --symlink-install` runs a link to it in another folder.
ROOT = Path(__file__).resolve().parent
NODES = ('anemometer', 'wind', 'solver', 'player', 'sensor', 'viewer')
LAUNCHER = '#!/bin/sh\nexec "$(dirname "$0")/../../bin/$(basename "$0")" "$@"\n'


def version():
    """Return the version, which is written in the package's ``__init__.py`` and nowhere else."""
    text = (ROOT / LIBRARY / '__init__.py').read_text(encoding='utf-8')
    return re.search(r"^__version__ = '(.+)'$", text, re.MULTILINE).group(1)


def launchers():
    """
    Write one small executable per node for ``lib/tree_sway_ros/``, and return their paths.

    ``ros2 run`` looks there. colcon installs the console scripts there itself (setup.cfg); pip
    puts them in ``bin/``, so a wheel brings these along, which go on to ``bin/``.
    """
    folder = Path('build', 'launchers')
    folder.mkdir(parents=True, exist_ok=True)
    for node in NODES:
        path = folder / node
        path.write_text(LAUNCHER, encoding='utf-8')
        path.chmod(0o755)
    return [str(folder / node) for node in NODES]


def files(pattern):
    """Return the files of the source that fit a pattern, from its root as setuptools asks."""
    return sorted(str(path.relative_to(ROOT)) for path in ROOT.glob(pattern) if path.is_file())


data_files = [
    ('share/ament_index/resource_index/packages', [f'resource/{PACKAGE}']),
    (f'share/{PACKAGE}', ['package.xml']),
    (f'share/{PACKAGE}/launch', files('launch/*.launch.py')),
    (f'share/{PACKAGE}/config', files('config/*')),
    (f'share/{PACKAGE}/config/examples', files('config/examples/*')),
]
if 'bdist_wheel' in sys.argv:
    data_files.append((f'lib/{PACKAGE}', launchers()))

NATIVE = 'tree_sway.core.native._sway'
SOURCES = ('gusts', 'model', 'place_layout', 'propagate', 'stand', 'target')
#: Options of the frame's code by target: it is compiled once for each, and chosen when it runs.
TARGETS = {
    'x86_64': {
        'baseline': [],
        'v3': ['-march=x86-64-v3'],
        'v4': ['-march=x86-64-v4', '-mprefer-vector-width=512'],
    },
}
OPTIONS = '-std=c++17 -O3 -fvisibility=hidden -fno-exceptions -fno-rtti -ffp-contract=fast'
OPTIONS += ' -fno-math-errno -fno-trapping-math -Wall -Wextra -Wno-psabi'
COMPILER = 'install a C++ compiler (Debian, Ubuntu: sudo apt install g++), or pip install ziglang'


class BuildNative(build_ext):
    """Compile the native core: C++ without its run-time library, opened by ctypes."""

    def get_ext_filename(self, fullname):
        """Return a name without the version of Python, which the core does not know."""
        return fullname.replace('.', '/') + ('.dll' if sys.platform == 'win32' else '.so')

    def build_extension(self, ext):
        """Compile each source, that of a frame for each target, and link them."""
        compiler = self.compiler
        choose_compiler(compiler)
        options = [*OPTIONS.split(), *([] if sys.platform == 'win32' else ['-fPIC'])]
        # Such as -fsanitize=address,undefined, which .ci/run tests the core with.
        more = os.environ.get('TREE_SWAY_CXXFLAGS', '').split()
        options += more
        folder = Path(self.build_temp, 'native')
        try:
            sources = [str(ROOT / 'native' / f'{name}.cpp') for name in SOURCES]
            objects = compiler.compile(sources, str(folder), extra_postargs=options)
            for name, own in targets().items():
                objects += compiler.compile(
                    [str(ROOT / 'native' / 'frame.cpp')],
                    str(folder / name),
                    macros=[('SWAY_FRAME', f'frame_{name}'), ('SWAY_TARGET', f'"{name}"')],
                    extra_postargs=[*options, *own],
                )
            target = self.get_ext_fullpath(ext.name)
            Path(target).parent.mkdir(parents=True, exist_ok=True)
            libraries = [] if sys.platform == 'win32' else ['m']
            compiler.link_shared_object(
                objects, target, libraries=libraries, target_lang='c', extra_postargs=more
            )
        except (CompileError, LinkError) as error:
            raise SystemExit(f'the native core is not built ({error}); {COMPILER}') from None


def targets():
    """Return the options of each target of this machine; the baseline alone on other machines."""
    return TARGETS.get(platform.machine().lower().replace('amd64', 'x86_64'), {'baseline': []})


def choose_compiler(compiler):
    """Compile by the system's C++ compiler, or by that of the package ziglang if there is none."""
    named = os.environ.get('CXX', '').split()
    found = next(filter(shutil.which, ('c++', 'g++', 'clang++')), None)
    linker = []
    if not named and found:
        named = [found]
    elif not named and find_spec('ziglang'):
        named = [sys.executable, '-m', 'ziglang', 'c++']
        linker = [*named[:-1], 'cc']
    if not named or (sys.platform == 'win32' and not linker):
        return
    options = ['-dynamiclib'] if sys.platform == 'darwin' else ['-shared']
    if sys.platform == 'linux':
        options.append('-Wl,--as-needed')  # nothing of the run-time library of C++ is needed
    chosen = {'compiler_so': named, 'compiler_so_cxx': named}
    chosen['linker_so'] = [*(linker or named), *options]
    known = compiler.executables  # compiler_so_cxx is new in setuptools 73
    compiler.set_executables(**{name: chosen[name] for name in chosen if name in known})


commands = {'build_ext': BuildNative}
if bdist_wheel is not None:

    class AnyPython(bdist_wheel):
        """A wheel for every Python 3 of one kind of machine."""

        def get_tag(self):
            """Return the tag of a wheel whose library knows nothing of Python."""
            return 'py3', 'none', super().get_tag()[2]

    commands['bdist_wheel'] = AnyPython


#: Versions of CPython for which all that is needed has wheels. test/test_packaging.py compares
#: every file that names versions.
PYTHONS = tuple(f'3.{minor}' for minor in range(10, 16))
LINUX = '; sys_platform == "linux" and platform_machine == "x86_64"'
extras = {
    # Bars for long waits; without tqdm a line is printed now and then.
    'progress': ['tqdm>=4.60'],
    # The real rclpy and Fast DDS as wheels; `pip -c .ci/constraints-ros-jazzy.txt` pins the rest.
    'ros': [
        f'ros-jazzy-rclpy[fastrtps]==7.1.6{LINUX}',
        f'ros-jazzy-common-interfaces==5.3.6{LINUX}',
    ],
    # Instruments on a serial port.
    'sensors': ['pyserial>=3.5'],
    'bag': ['rosbags>=0.11'],
    'plot': ['matplotlib>=3.6'],
    'film': ['matplotlib>=3.6', 'imageio-ffmpeg>=0.5'],
    # colcon runs pytest only where an extra of this name asks for it.
    'test': [
        'pytest>=7,<9',
        'pytest-xdist>=3.2',
        'pytest-cov>=4',
        'hypothesis>=6.60',
        'mpmath>=1.2',
        'pygltflib>=1.16',
        'trimesh>=4.0',
        'usd-core>=24.5',
    ],
    'lint': [
        'ruff>=0.8',
        'mypy>=1.11',
        'codespell[toml]>=2.3',
        'types-PyYAML',
        'types-jsonschema',
    ],
    # Studies on all cores or a cluster; tables as Parquet.
    'study': ['distributed>=2023.1', 'cryptography>=41'],
    'parquet': ['pyarrow>=12'],
    # Wind of reanalyses; inventories in spreadsheets.
    'netcdf': ['netCDF4>=1.6'],
    'inventory': ['openpyxl>=3.1'],
    'docs': ['sphinx>=7', 'myst-parser>=2'],
}

setup(
    name=PACKAGE,
    version=version(),
    description='Trees that sway in measured wind, solved in real time and streamed over ROS 2',
    long_description=(ROOT / 'README.md').read_text(encoding='utf-8'),
    long_description_content_type='text/markdown',
    author='Tree Sway maintainers',
    author_email='maintainers@users.noreply.github.com',
    maintainer='Tree Sway maintainers',
    maintainer_email='maintainers@users.noreply.github.com',
    license='Apache-2.0',
    packages=find_packages(str(ROOT), include=[PACKAGE, f'{PACKAGE}.*', LIBRARY, f'{LIBRARY}.*']),
    package_data={
        '': [
            'py.typed',
            '*.json',
            '*.yaml',
            '*.csv',
            '*.xml',
            'static/*',
            'static/*/*',
            'pictures/*.png',
        ]
    },
    data_files=data_files,
    python_requires=f'>={PYTHONS[0]}',
    classifiers=[f'Programming Language :: Python :: {version}' for version in PYTHONS],
    install_requires=[
        'setuptools',
        'numpy>=1.26',
        'scipy>=1.11',
        'PyYAML>=6',
        'jsonschema>=4.10',
        'aiohttp>=3.8',
        'tqdm>=4.60',
    ],
    extras_require=extras,
    ext_modules=[Extension(NATIVE, [])],
    cmdclass=commands,
    zip_safe=False,
    entry_points={
        'console_scripts': [
            *(f'{node} = {PACKAGE}.nodes.executables:{node}' for node in NODES),
            f'tree-sway = {LIBRARY}.commands.cli:main',
        ],
        'tree_sway.commands': [f'ros = {PACKAGE}.commands.table:COMMANDS'],
        'ament_copyright.license': [
            f'apache2_by_spdx = {PACKAGE}.licence_header:APACHE_BY_SPDX',
        ],
    },
)
