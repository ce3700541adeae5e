#!/usr/bin/env python3
# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Run a command in this checkout's own virtual environment, made first if it is not there.

    python3 .ci/in_venv.py tree-sway demo
    python3 .ci/in_venv.py pytest
    python3 .ci/in_venv.py --with lint,wasm pytest

Needs Python 3.10 or newer, and the network the first time. The package is installed in editable
form, with what the commands of the library need, and the further parts of the one that is named:
`tree-sway demo` brings the real rclpy and Fast DDS of hashes-ros-jazzy.txt and no other (x86_64
Linux, Python 3.10-3.14), `pytest` what the tests use, `ruff` the linters. A later command adds
what it lacks, unless `--with` has named it before. The environment is made again when the Python
differs and brought up to date when a file that describes the installation has changed.
TREE_SWAY_VENV names another place for it than .venv, and TREE_SWAY_UV a uv that installs in place
of pip, in a fraction of the time, as `.ci/run` has it.

"""

import fcntl
import hashlib
import os
from pathlib import Path
import platform
import re
import shutil
import subprocess
import sys
import time

ROOT = Path(__file__).resolve().parent.parent
VENV = Path(os.environ.get('TREE_SWAY_VENV') or ROOT / '.venv').absolute()
CONSTRAINTS = ROOT / '.ci' / 'constraints-ros-jazzy.txt'
HASHES = ROOT / '.ci' / 'hashes-ros-jazzy.txt'
#: The oldest Python that this package runs on, and the newest that there are ROS wheels for.
OLDEST, NEWEST_WITH_ROS = (3, 10), (3, 14)
#: What is always installed: bars for waits, and what the commands of the library
#: use. Other parts are large: ROS, the encoder of MP4 (165 MB), Parquet (170 MB).
ALWAYS = ('progress', 'plot', 'study', 'bag', 'sensors')
#: Extras that a command needs beside those, by the program or by the command of `tree-sway`.
NEEDS = {
    **dict.fromkeys(
        ('anemometer', 'wind', 'solver', 'player', 'sensor', 'viewer', 'ros2'), ('ros',)
    ),
    **dict.fromkeys(
        ('tree-sway demo', 'tree-sway listen', 'tree-sway relay', 'tree-sway record'), ('ros',)
    ),
    'tree-sway render': ('film',),
    'tree-sway lab': ('ros', 'lab'),
    **dict.fromkeys(
        ('pytest', 'py.test'),
        (
            'ros',
            'film',
            'camera',
            'parquet',
            'netcdf',
            'inventory',
            'test',
            'lab',
            'docs',
        ),
    ),
    'coverage': ('test',),
    **dict.fromkeys(('ruff', 'mypy', 'codespell', 'clang-format', 'pre-commit'), ('lint',)),
    'sphinx-build': ('docs',),
    'python setup.py': ('wasm',),
    'python .ci/without_annexes.py': ('test',),
}
#: Extras that a file needs which is named on the command line, by its suffix.
NEEDS_OF_FILES = {
    '.parquet': 'parquet',
    '.nc': 'netcdf',
    '.xlsx': 'inventory',
}
#: What a sourced ROS sets; its libraries and these wheels must not meet in one process.
ROS_NAMES = (
    'AMENT_PREFIX_PATH',
    'CMAKE_PREFIX_PATH',
    'COLCON_PREFIX_PATH',
    'LD_LIBRARY_PATH',
    'PYTHONPATH',
    'ROS_DISTRO',
    'ROS_ETC_DIR',
    'ROS_PYTHON_VERSION',
    'ROS_VERSION',
)


def main(command):
    """Make the environment ready and become the command in it."""
    further = set()
    if command[:1] == ['--with']:
        further, command = {*''.join(command[1:2]).split(',')}, command[2:]
    if not command:
        stop('no command given', 'for example: python3 .ci/in_venv.py tree-sway demo')
    extras = extras_for(command) | further
    environment = without_ros(dict(os.environ))
    # Set by the ROS wheels of another checkout, the second keeps those here from being found.
    for name in ('PYTHONHOME', '_ROS_WHEELS_BOOTSTRAP_COMPLETE'):
        environment.pop(name, None)
    with open(__file__) as lock:  # one set-up at a time, however many start at once
        fcntl.flock(lock, fcntl.LOCK_EX)
        make_ready(environment, extras)
    programs = str(VENV / 'bin')
    environment.update(
        VIRTUAL_ENV=str(VENV),
        AMENT_PREFIX_PATH=str(VENV),
        PATH=os.pathsep.join([programs, environment.get('PATH', os.defpath)]),
    )
    program = shutil.which(command[0], path=environment['PATH'])
    if program is None:
        stop('no such command: ' + command[0], 'what is installed is in ' + programs)
    os.execve(program, [program, *command[1:]], environment)


def stop(what, cure):
    """Say what is wrong and what to do about it, on one line, and end."""
    print(f'in_venv: {what}; {cure}', file=sys.stderr)
    sys.exit(2)


def extras_for(command):
    """Return the extras that a command needs; refuse it where this Python or machine has none."""
    names = [os.path.basename(command[0])]
    names += [argument for argument in command[1:] if not argument.startswith('-')][:1]
    needed = {*ALWAYS, *NEEDS.get(names[0], ()), *NEEDS.get(' '.join(names), ())}
    if '--sensor' in command and names[-1] == 'record':
        needed.discard('ros')  # the wind of a live source is recorded without it
    if '--page' in command and names[-1] == 'relay':
        needed.discard('ros')
    for argument in command[1:]:
        path = Path(argument.rpartition('=')[2])
        if path.suffix in NEEDS_OF_FILES:
            needed.add(NEEDS_OF_FILES[path.suffix])
    if names[0] == 'pytest' and no_ros_wheels():
        needed.discard('ros')  # the tests that need it say that they are left out
    check_machine('ros' in needed)
    return needed


def no_ros_wheels():
    """Return why there are no ROS wheels here and the cure; None where there are."""
    fitting = f'3.10 to 3.{NEWEST_WITH_ROS[1]}'
    if (sys.platform, platform.machine()) != ('linux', 'x86_64'):
        return (
            f'the ROS wheels are for x86_64 Linux, not {platform.machine()} {sys.platform}',
            'use a ROS installation (README), or `tree-sway show`, which needs no ROS',
        )
    if sys.version_info[:2] > NEWEST_WITH_ROS:
        return f'the ROS wheels are for Python {fitting}, not {platform.python_version()}', other()
    return None


def check_machine(with_ros):
    """Refuse a Python that is too old, or with ROS a machine that there are no wheels for."""
    if sys.version_info[:2] < OLDEST:
        stop(f'Python {platform.python_version()} is too old, 3.10 is the least', other())
    if with_ros and no_ros_wheels():
        stop(*no_ros_wheels())


def other():
    """Say which other Python to take."""
    fitting = [shutil.which(f'python3.{minor}') for minor in (12, 13, 11, 14, 10)]
    found = next(filter(None, fitting), None)
    return f'run it with {found or "one of those, from your system or python.org"}'


def without_ros(environment):
    """Take a sourced ROS installation out of the environment, and say so."""
    if not environment.get('ROS_DISTRO') and not environment.get('AMENT_PREFIX_PATH'):
        return environment
    if environment.get('AMENT_PREFIX_PATH') != str(VENV):
        distro = environment.get('ROS_DISTRO', 'ROS')
        say(f'leaving the sourced {distro} aside, as .venv has its own')
    kept = {name: value for name, value in environment.items() if name not in ROS_NAMES}
    search = environment.get('PATH', '').split(os.pathsep)
    kept['PATH'] = os.pathsep.join(p for p in search if not p.startswith('/opt/ros/'))
    return kept


def wanted():
    """Return what the environment must have been made from, as one line."""
    names = ('setup.py', 'setup.cfg', 'pyproject.toml', 'package.xml', 'lab/pyproject.toml')
    files = [ROOT / name for name in names]
    files += [CONSTRAINTS, HASHES, Path(__file__).resolve()]
    files += sorted((ROOT / 'native').iterdir())  # compiled by the installation
    digest = hashlib.sha256()
    for path in files:
        if path.is_file():
            digest.update(path.name.encode() + b'\0' + path.read_bytes())
    version = '.'.join(platform.python_version_tuple()[:2])
    return [version, str(ROOT), digest.hexdigest()]


def make_ready(environment, extras):
    """Create the environment and install into it, unless it is there, up to date and enough."""
    stamp = VENV / 'tree_sway_ros.stamp'
    runs = (VENV / 'bin' / 'python').exists() and (VENV / 'bin' / 'pip').exists()
    made_from = stamp.read_text().split('\n') if runs and stamp.is_file() else ['']
    there = set(made_from[3].split(',')) if len(made_from) > 3 else set()
    if made_from[:3] == wanted() and there >= extras:
        return
    began = time.monotonic()
    if made_from[0] != wanted()[0]:
        there = set()
        size = '0.8 GB' if 'ros' in extras else '0.7 GB'
        more = ' and the tests' * ('test' in extras)
        say(f'setting up {VENV}, once: some minutes and {size}{more}')
        make_venv(environment)
        pip(environment, 'setuptools>=70.1,<81')
    elif made_from[:3] == wanted():
        say(f'adding to {VENV}, once: {", ".join(sorted(extras - there))}')
    else:
        say(f'bringing {VENV} up to date')
    if 'ros' in there | extras and not ('ros' in there and made_from[:3] == wanted()):
        # By their hashes: they are built by one person (doc/licences.md).
        pip(environment, '--require-hashes', '--no-deps', '-r', str(HASHES))
    if not any(map(shutil.which, ('c++', 'g++', 'clang++', os.environ.get('CXX', 'c++')))):
        say('no C++ compiler here, so taking ziglang, 0.5 GB; smaller: sudo apt install g++')
        pip(environment, 'ziglang>=0.13')
    target = f'{ROOT}[{",".join(sorted((there | extras) - {"lab"}))}]'
    pip(environment, '-c', str(CONSTRAINTS), '--no-build-isolation', '-e', target)
    if 'lab' in there | extras:  # a project of its own, with what its truths need
        laboratory = f'{ROOT / "lab"}[sundials]'
        pip(environment, '-c', str(CONSTRAINTS), '--no-build-isolation', '-e', laboratory)
    link_resources()
    stamp.write_text('\n'.join([*wanted(), ','.join(sorted(there | extras))]))
    say(f'ready after {time.monotonic() - began:.0f} s')


def link_resources():
    """Put in place what an editable installation omits: the ament index, share/ and lib/."""
    index = VENV / 'share' / 'ament_index' / 'resource_index' / 'packages'
    share = VENV / 'share' / 'tree_sway_ros'
    executables = VENV / 'lib' / 'tree_sway_ros'
    for folder in (share, executables):  # what has gone from the checkout goes here too
        shutil.rmtree(folder, ignore_errors=True)
    links = {index / 'tree_sway_ros': ROOT / 'resource' / 'tree_sway_ros'}
    # File by file: `ros2 launch` looks for its files where os.walk goes, which passes linked
    # folders by.
    shared = [ROOT / 'package.xml', *ROOT.glob('launch/*.py'), *ROOT.glob('config/*')]
    links.update({share / path.relative_to(ROOT): path for path in shared})
    for entry_points in VENV.glob('lib/python*/site-packages/tree_sway_ros-*/entry_points.txt'):
        for line in entry_points.read_text().splitlines():
            if '= tree_sway_ros.nodes.' in line:
                name = line.split()[0]
                links[executables / name] = VENV / 'bin' / name
    for link, target in links.items():
        link.parent.mkdir(parents=True, exist_ok=True)
        if link.is_symlink():
            link.unlink()
        link.symlink_to(target)


def make_venv(environment):
    """Create an empty virtual environment with pip in it."""
    try:
        import ensurepip  # noqa: F401
        import venv  # noqa: F401
    except ImportError:
        stop(
            'this Python cannot make virtual environments (ensurepip is missing)',
            'on Debian or Ubuntu: sudo apt install python3-venv',
        )
    result = subprocess.run(
        [sys.executable, '-m', 'venv', '--clear', str(VENV)],
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    if result.returncode:
        reason = (result.stdout.strip() or 'no reason given').splitlines()[-1]
        stop(f'cannot create {VENV}: {reason}', 'make room or rights there and run this again')


def pip(environment, *arguments):
    """Install with pip, one line of progress; its own words go to a log beside the environment."""
    log = VENV / 'setup.log'
    python = str(VENV / 'bin' / 'python')
    if uv := os.environ.get('TREE_SWAY_UV'):
        command = [uv, 'pip', 'install', '--python', python]
    else:
        command = [python, '-m', 'pip', 'install', '--progress-bar', 'off']
        # Few modules of what is installed are ever loaded, and each is compiled when it is first.
        command += ['--disable-pip-version-check', '--no-compile']
    process = subprocess.Popen(
        [*command, *arguments],
        cwd=str(ROOT),
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    seen = []
    count = 0
    with log.open('w') as record:
        for line in process.stdout:
            record.write(line)
            seen.append(line)
            words = line.split()
            if words[:1] == ['Collecting']:
                count += 1
                progress(f'  {count:3d} packages, now {words[1][:40]}')
            elif words[:2] == ['Installing', 'collected']:
                progress(f'  installing {len(words) - 3} packages')
    progress('')
    if process.wait():
        stop(*failure(''.join(seen), log))


def failure(words, log):
    """Return what went wrong and the cure, from pip's words."""
    signs = 'NewConnectionError|Name or service|name resolution|ConnectTimeout|ProxyError'
    if re.search(signs, words):
        cure = 'connect, or set a proxy, and run again'
        return 'no network: the package index cannot be reached', cure
    if 'No space left' in words:
        return 'the disk is full', f'make about 1 GB of room at {VENV}'
    native = re.search('(the native core is not built.*?); (.*)', words)
    if native:
        return native.groups()
    errors = [line for line in words.splitlines() if line.startswith('ERROR')]
    return (errors or ['pip failed'])[0], f"pip's own words are in {log}"


def say(text):
    """Print a line for people; standard output belongs to the command."""
    print('in_venv: ' + text, file=sys.stderr, flush=True)


def progress(text):
    """Show a line that the next one replaces, where there is a terminal."""
    if sys.stderr.isatty():
        print('\r\033[K' + text, end='', file=sys.stderr, flush=True)


if __name__ == '__main__':
    try:
        main(sys.argv[1:])
    except KeyboardInterrupt:
        sys.exit('in_venv: interrupted; run it again to go on')
