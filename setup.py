# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Build tree_sway_ros: under colcon as an ament_python package, under pip as a wheel."""

from concurrent.futures import ThreadPoolExecutor
from importlib.util import find_spec
import os
from pathlib import Path
import platform
import re
import shutil
import subprocess
import sys
from tempfile import TemporaryDirectory
import zlib

from setuptools import Command, Extension, find_packages, setup
from setuptools.command.build_ext import build_ext

try:
    from setuptools.command.bdist_wheel import bdist_wheel
except ImportError:  # an older setuptools, which builds no wheel of this package
    bdist_wheel = None

PACKAGE = 'tree_sway_ros'
LIBRARY = 'tree_sway'
#: The folder of this file; `colcon build --symlink-install` runs a link to it in another folder.
ROOT = Path(__file__).resolve().parent
NODES = ('anemometer', 'wind', 'solver', 'player', 'sensor', 'viewer')
#: Houses of the library that bring commands.
HOUSES = (
    'files', 'forest', 'growth', 'identification', 'page', 'pictures', 'simulation',
)  # fmt: skip
#: Kinds of objects that have a picture, and the function that draws each.
DRAWN = {
    'Tree': 'of_tree', 'TreeFile': 'of_tree', 'WindRecord': 'of_wind', 'SwayRecord': 'of_sway',
    'MotionRecord': 'of_motion', 'html': 'as_html',
}  # fmt: skip
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
SOURCES = (
    'branch_loads', 'far_wind', 'gusts', 'limp_layout', 'model', 'observe', 'place_layout',
    'propagate', 'room', 'samples', 'stand', 'target', 'threads',
)  # fmt: skip
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
#: Wheels that ziglang compiles on any machine: tag of the platform, and its name of the target.
WHEELS = {
    'manylinux_2_17_x86_64': 'x86_64-linux-gnu.2.17',
    'manylinux_2_17_aarch64': 'aarch64-linux-gnu.2.17',
    'macosx_10_13_x86_64': 'x86_64-macos.10.13',
    'macosx_11_0_arm64': 'aarch64-macos.11.0',
    'win_amd64': 'x86_64-windows-gnu',
}
#: One of them, or this machine.
WHEEL = os.environ.get('TREE_SWAY_WHEEL', '')
SYSTEM = WHEEL or sys.platform
IS_WINDOWS = SYSTEM.startswith('win')
MACHINE = 'x86_64' if re.search('x86_64|amd64', WHEEL or platform.machine().lower()) else 'other'


class BuildNative(build_ext):
    """Compile the native core: C++ without its run-time library, opened by ctypes."""

    def get_ext_filename(self, fullname):
        """Return a name without the version of Python, which the core does not know."""
        return fullname.replace('.', '/') + ('.dll' if IS_WINDOWS else '.so')

    def build_extension(self, ext):
        """Compile each source, that of a frame for each target, and link them."""
        compiler = compiler_words()
        if not compiler:
            raise SystemExit(f'the native core is not built, as there is no compiler; {COMPILER}')
        is_zig = 'ziglang' in compiler
        # Such as -fsanitize=address,undefined, which .ci/run tests the core with.
        more = os.environ.get('TREE_SWAY_CXXFLAGS', '').split()
        options = [*OPTIONS.split(), *([] if IS_WINDOWS else ['-fPIC', '-pthread']), *more]
        # What the library is built of, which `tree_sway.core.native.library` asks it for.
        headers = [(ROOT / 'native' / name).read_bytes() for name in ('sway.h', 'library.h')]
        options += [f'-DSWAY_INTERFACE={zlib.crc32(b"".join(headers))}u']
        folder = Path(self.build_temp, 'native')
        folder.mkdir(parents=True, exist_ok=True)
        objects, commands = [], []

        def compiled(name, source, *own):
            path = ROOT / 'native' / f'{source}.cpp'
            objects.append(str(folder / f'{name}.o'))
            commands.append([*compiler, *options, *own, '-c', str(path), '-o', objects[-1]])

        # Those of the frame take longest.
        for name, own in TARGETS.get(MACHINE, {'baseline': []}).items():
            if is_zig:
                own = [each.replace('x86-64-v', 'x86_64_v') for each in own]
            compiled(f'frame_{name}', 'frame', f'-DSWAY_FRAME=frame_{name}', *own)
        for name in SOURCES:
            compiled(name, name)
        run_all(commands)
        # Nothing of the run-time library of C++ is needed.
        linker = ['cc' if word == 'c++' else word for word in compiler] if is_zig else compiler
        linked = folder / Path(self.get_ext_filename(ext.name)).name
        own = ['-shared', '-s'] if is_zig else ['-shared']
        own += [] if IS_WINDOWS else ['-lm', '-pthread']
        own += ['-Wl,--as-needed'] if 'linux' in SYSTEM else []
        run([*linker, *own, *objects, *more, '-o', str(linked)])
        target = Path(self.get_ext_fullpath(ext.name))
        target.parent.mkdir(parents=True, exist_ok=True)
        target.unlink(missing_ok=True)  # a process that has it open keeps it
        shutil.copy(linked, target)


def run_all(commands):
    """Run compilers, as many at a time as there are processors."""
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        list(pool.map(run, commands))


def run(words):
    """Run a compiler, or end with the cure."""
    if subprocess.run(words, check=False).returncode:
        raise SystemExit(f'the native core is not built: {words[0]} failed; {COMPILER}')


def compiler_words():
    """Return the system's C++ compiler, or that of the package ziglang if there is none."""
    named = os.environ.get('CXX', '').split()
    # That of Visual Studio has no vectors, and GCC does not align them on Windows.
    usual = ('clang++',) if IS_WINDOWS else ('c++', 'g++', 'clang++')
    if WHEEL:
        zig = ['-target', WHEELS[WHEEL]]
    elif named or any(map(shutil.which, usual)):
        return named or [next(filter(shutil.which, usual))]
    else:
        zig = ['-mcpu=baseline']
    return [sys.executable, '-m', 'ziglang', 'c++', *zig] if find_spec('ziglang') else []


#: What pip asks for before it builds apart from what is installed.
IS_ASKED = 'setuptools.build_meta' in sys.modules and 'egg_info' in sys.argv
NEEDED = ['ziglang>=0.13'] if IS_ASKED and not compiler_words() else []


#: The compiler of the page's core: another version makes other bytes.
ZIG = '0.17.1'
WASM = 'tree_sway/page/static/sway.wasm'
#: What the page calls.
EXPORTS = (
    'calloc', 'free', 'sway_model_open', 'sway_model_close', 'sway_stand_open',
    'sway_stand_close', 'sway_state', 'sway_set_step', 'sway_step', 'sway_past_winds',
    'page_placer_open', 'page_placer_close', 'page_place', 'page_steps',
)  # fmt: skip


#: What it calls of the browser's Math.
MATH = ('atan2', 'cos', 'exp', 'expm1', 'log', 'pow', 'sin')


class BuildWasm(Command):
    """Compile the native core for the page: WebAssembly without a run-time library."""

    description = f'compile {WASM} by ziglang=={ZIG}'
    user_options = [  # noqa: RUF012
        ('check', None, 'compare with the file that is there, and write nothing')
    ]
    boolean_options = ('check',)

    def initialize_options(self):
        """Write the file."""
        self.check = False

    def finalize_options(self):
        """Need nothing more."""

    def run(self):
        """Compile each source, small but for the frame, and link them."""
        zig = [sys.executable, '-m', 'ziglang']
        try:
            found = subprocess.check_output([*zig, 'version'], text=True).strip()
        except subprocess.CalledProcessError:
            found = 'none'
        if found != ZIG:
            raise SystemExit(f'ziglang is {found}: pip install ziglang=={ZIG}')
        # The headers are those of WASI; its library stays out.
        options = [*OPTIONS.split(), '-target', 'wasm32-wasi', '-msimd128', '-DSWAY_PAGE']
        # Lanes are those of vec.h.
        frame = ['-O2', '-fno-vectorize', '-fno-slp-vectorize']
        frame += ['-DSWAY_FRAME=frame_baseline']
        with TemporaryDirectory() as folder:
            objects = []
            for name in (*(each for each in SOURCES if each != 'threads'), 'page', 'frame'):
                own = frame if name == 'frame' else ['-Oz']
                objects.append(f'{folder}/{name}.o')
                source = f'native/{name}.cpp'
                command = [*zig, 'c++', *options, *own, '-c', source, '-o', objects[-1]]
                subprocess.run(command, cwd=ROOT, check=True)
            Path(folder, 'math').write_text('\n'.join(MATH), encoding='utf-8')
            linked = ['--no-entry', f'--allow-undefined-file={folder}/math', '--stack-first', '-s']
            linked += [f'--export={name}' for name in EXPORTS]
            linked += ['-z', 'stack-size=65536', '-o', f'{folder}/wasm']
            subprocess.run([*zig, 'wasm-ld', *linked, *objects], check=True)
            made = Path(folder, 'wasm').read_bytes()
        if not self.check:
            (ROOT / WASM).write_bytes(made)
        elif made != (ROOT / WASM).read_bytes():
            raise SystemExit(f'{WASM} is of other sources: python setup.py build_wasm')


commands = {'build_ext': BuildNative, 'build_wasm': BuildWasm}
if bdist_wheel is not None:

    class AnyPython(bdist_wheel):
        """A wheel for every Python 3 of one kind of machine."""

        def get_tag(self):
            """Return the tag of a wheel whose library knows nothing of Python."""
            return 'py3', 'none', WHEEL or super().get_tag()[2]

    commands['bdist_wheel'] = AnyPython


#: Versions of CPython for which all that is needed has wheels. test/test_packaging.py compares
#: every file that names versions.
PYTHONS = tuple(f'3.{minor}' for minor in range(10, 16))
LINUX = '; sys_platform == "linux" and platform_machine == "x86_64"'
extras = {
    # The compiler of the page's core (python setup.py build_wasm).
    'wasm': [f'ziglang=={ZIG}'],
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
    # Films and live cameras.
    'camera': ['opencv-python-headless>=4.5'],
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
        'clang-format==23.1.5',
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
    setup_requires=NEEDED,
    ext_modules=[Extension(NATIVE, [])],
    cmdclass=commands,
    zip_safe=False,
    entry_points={
        'console_scripts': [
            *(f'{node} = {PACKAGE}.nodes.executables:{node}' for node in NODES),
            f'tree-sway = {LIBRARY}.commands.cli:main',
        ],
        'tree_sway.commands': [
            *(f'{house} = {LIBRARY}.{house}.commands:COMMANDS' for house in HOUSES),
            f'ros = {PACKAGE}.commands:COMMANDS',
        ],
        'tree_sway.show': [
            f'forest = {LIBRARY}.forest.commands.on_the_page:RiskOnThePage',
            f'twin = {LIBRARY}.twin.commands.on_the_page:SensorsOnThePage',
        ],
        'tree_sway.choosers': [f'auto = {LIBRARY}.fidelity:AdaptiveSimulator'],
        'tree_sway.pictures': [
            f'{kind} = {LIBRARY}.pictures.figures:{function}' for kind, function in DRAWN.items()
        ],
        f'{PACKAGE}.solver': [f'motion = {PACKAGE}.motion.annex:MotionAnnex'],
        'ament_copyright.license': [
            f'apache2_by_spdx = {PACKAGE}.licence_header:APACHE_BY_SPDX',
        ],
    },
)
