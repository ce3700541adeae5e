# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Build tree_sway_ros: under colcon as an ament_python package, under pip as a wheel."""

from pathlib import Path
import re
import sys

from setuptools import find_packages, setup

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

#: Versions of CPython for which all that is needed has wheels. test/test_packaging.py compares
#: every file that names versions.
PYTHONS = tuple(f'3.{minor}' for minor in range(10, 16))
LINUX = '; sys_platform == "linux" and platform_machine == "x86_64"'
#: Where numba has wheels; elsewhere pip would try to compile it, and a tree runs on numpy.
NUMBA = (
    'numba>=0.59; platform_python_implementation == "CPython" and '
    f'python_version <= "{PYTHONS[-1]}" and '
    '(sys_platform == "linux" and platform_machine == "x86_64" or '
    'sys_platform == "linux" and platform_machine == "aarch64" or '
    'sys_platform == "win32" and platform_machine == "AMD64" or '
    'sys_platform == "darwin" and platform_machine == "arm64")'
)
extras = {
    # Compiled kernels; without numba the same model runs on numpy, slower (doc/faq.md).
    'fast': ['numba>=0.59'],
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
        NUMBA,
    ],
    extras_require=extras,
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
