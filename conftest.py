# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""For all tests: Hypothesis that repeats, a ROS domain each, small trees."""

import contextlib
import faulthandler
import functools
import gc
from importlib.metadata import EntryPoint
import importlib.util
import os
from pathlib import Path
import random
import re
import socket
import sys
import time

# Before a participant is made: the profile counts for the whole process.
PROFILE = Path(__file__).parent / 'tree_sway_ros' / 'process' / 'discovery.xml'
os.environ.setdefault('FASTRTPS_DEFAULT_PROFILES_FILE', str(PROFILE))
# Before numpy is loaded: matrices here are small, and idle threads of BLAS that spin slow down the
# test beside.
os.environ.setdefault('OPENBLAS_NUM_THREADS', '1')

import drawn_trees  # noqa: E402
from hypothesis import settings  # noqa: E402
import numpy as np  # noqa: E402
import pytest  # noqa: E402

from tree_sway.cache.model_cache import MODELS as ON_DISK  # noqa: E402
from tree_sway.core.model.model_cache import PREPARED  # noqa: E402
from tree_sway.errors import MissingDependencyError  # noqa: E402
from tree_sway.installed_models import GROUP, installed_models  # noqa: E402

# The laboratory of this checkout may not be installed, or have been before it had models.
if importlib.util.find_spec('tree_sway_lab') is not None:
    _FULL = EntryPoint('full', 'tree_sway_lab.full.assembly:full_bank', GROUP)
    installed_models().setdefault('full', _FULL)

# The same commit passes or fails alike everywhere; HYPOTHESIS_PROFILE=explore looks further.
settings.register_profile('repeatable', derandomize=True, deadline=None)
settings.register_profile('explore', deadline=None, max_examples=1000)
settings.load_profile(os.environ.get('HYPOTHESIS_PROFILE', 'repeatable'))


LAST_DOMAIN = 101
"""Of those whose ports are not handed out by the system."""

_FIRST_PORT, _PORTS_OF_DOMAIN = 7400, 250
"""Ports of RTPS: of domain 0, and of each domain."""


ROOT = Path(__file__).parent

CORE_FOLDERS = [ROOT / 'test' / name for name in ('core', 'growth')]
"""The suite of the core, which passes without any annex."""

LONG_FOLDERS = [ROOT / 'lab' / 'test' / name for name in ('battery', 'methods')]
"""Tests of integrators that no product runs; each compiles kernels of its own."""


LONGEST, LONGEST_LONG = 900.0, 3600.0
"""
Time after which a test hangs, with its fixtures, and one that is marked `long` [s].

The slowest takes 20 s alone, and took more than 300 s with a tenth of a core.
"""


@pytest.hookimpl(tryfirst=True)
def pytest_cmdline_main(config):
    """With -n, let a worker that has no tests left take some from another."""
    if getattr(config.option, 'numprocesses', None) and config.option.dist == 'no':
        config.option.dist = 'worksteal'


def pytest_configure(config):
    """Keep what errors are written to, before tests have it captured."""
    global _errors
    _errors = os.dup(2)


@functools.cache
def _marks_of(file):
    """Return the marks that all tests of a file have by its folder."""
    folders = {'core': CORE_FOLDERS, 'long': LONG_FOLDERS}
    return [name for name in folders if any(map(file.is_relative_to, folders[name]))]


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items):
    """Mark tests of the core, those that open Chromium, and long ones, before any is chosen."""
    for item in items:
        for name in _marks_of(item.path):
            item.add_marker(name)
        if 'one_chromium' in getattr(item, 'fixturenames', ()):
            item.add_marker('browser')


@pytest.hookimpl(hookwrapper=True)
def pytest_collection():
    """Search no garbage among what lasts: thousands of tests and the modules that they load."""
    gc.disable()
    yield
    gc.collect()
    gc.freeze()
    gc.enable()


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_protocol(item):
    """
    End the process of a test that hangs, so that it fails by its name, with all its stacks.

    No signal and no thread of Python would: middleware that waits may hold the interpreter.
    """
    longest = LONGEST_LONG if item.get_closest_marker('long') else LONGEST
    faulthandler.dump_traceback_later(longest, exit=True, file=_errors)
    yield
    faulthandler.cancel_dump_traceback_later()


@pytest.fixture
def memory_alone():
    """Measure no coverage in a test that counts memory: lines that are seen take some."""
    module = sys.modules.get('coverage')
    measured = module and module.Coverage.current()
    if measured:
        measured.stop()
    yield
    if measured:
        measured.start()


def _claimed_port(domain):
    """
    Return a socket that claims a ROS domain on this machine; None if it is in use.

    Participants of a domain bind ports of its own range, from the lowest on. The highest one,
    which only the 120th would bind, is the claim: the system gives it to one process at a time,
    and takes it back whatever that dies of. Where another port is bound, a graph is alive that no
    test has claimed, such as a demo: its messages would be heard.
    """
    first = _FIRST_PORT + _PORTS_OF_DOMAIN * domain
    claim = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    try:
        claim.bind(('', first + _PORTS_OF_DOMAIN - 1))
        for port in range(first, first + _PORTS_OF_DOMAIN - 1):
            with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
                probe.bind(('', port))
    except OSError:
        claim.close()
        return None
    return claim


@contextlib.contextmanager
def _claimed_domain():
    """Claim a ROS domain in which nobody is heard, for one test on this machine."""
    # Anywhere first: a domain that was left a moment ago may still hold what it last sent.
    for domain in random.sample(range(1, LAST_DOMAIN + 1), LAST_DOMAIN):
        claim = _claimed_port(domain)
        if claim is not None:
            with claim:
                yield domain
            return
    pytest.fail('all ROS domains are in use on this machine')


@pytest.fixture(scope='session')
def shared_folder(tmp_path_factory):
    """Return a folder of this run, the same for all workers."""
    base = tmp_path_factory.getbasetemp()
    return base.parent if 'PYTEST_XDIST_WORKER' in os.environ else base


@pytest.fixture(scope='session', autouse=True)
def models_are_prepared_once(shared_folder):
    """Keep all prepared models in a folder of the run: many tests simulate the same trees."""
    kept = ON_DISK.folder, ON_DISK.most, PREPARED.behind
    ON_DISK.folder, ON_DISK.most = shared_folder / 'prepared_models', 10_000
    ON_DISK.folder.mkdir(exist_ok=True)
    PREPARED.behind = ON_DISK
    yield
    ON_DISK.folder, ON_DISK.most, PREPARED.behind = kept


@pytest.fixture(scope='session')
def claimed_domain():
    """Claim a ROS domain, to the end of a block, for fixtures that outlive a test."""
    return _claimed_domain


@pytest.fixture
def domain():
    """Claim a ROS domain for one test alone."""
    pytest.importorskip('rclpy', reason='ROS 2 is not installed')
    with _claimed_domain() as claimed:
        yield claimed


@pytest.fixture
def ros_environment(domain):
    """Environment of a process in a ROS domain for one test alone, on this machine alone."""
    own = {'ROS_DOMAIN_ID': str(domain), 'ROS_AUTOMATIC_DISCOVERY_RANGE': 'LOCALHOST'}
    return os.environ | own


@pytest.fixture
def little_effort():
    """Fail a test that takes 5 s of a processor or 1 GiB more memory: what hostile input may."""
    peak = _peak_memory()
    began = time.process_time()
    yield
    spent, grown = time.process_time() - began, _peak_memory(restarted=False) - peak
    assert spent < 5.0, f'{spent:.1f} s of a processor'
    assert grown < 2**30, f'{grown / 2**20:.0f} MiB'


def _peak_memory(restarted=True):
    """Return the peak memory of this process, to be counted from now on [bytes]; 0 elsewhere."""
    if not sys.platform.startswith('linux'):
        return 0
    if restarted:
        Path('/proc/self/clear_refs').write_text('5')
    status = Path('/proc/self/status').read_text(encoding='ascii')
    return 1024 * int(status.partition('VmHWM:')[2].split()[0])


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_makereport(item, call):
    """Skip what turns out to need an optional package that is missing."""
    if call.excinfo and _lacks(call.excinfo.value):
        try:
            pytest.skip(str(call.excinfo.value))
        except pytest.skip.Exception:
            call.excinfo = pytest.ExceptionInfo.from_current()


def _lacks(error):
    """Tell whether an error is that of something optional, and that is not there indeed."""
    if not isinstance(error, (MissingDependencyError, ModuleNotFoundError)):
        return False
    missing = re.search(r"No module named '(\w+)", str(error))
    return missing is not None and importlib.util.find_spec(missing[1]) is None


@pytest.fixture
def short_storms(monkeypatch):
    """Find strength in winds of one minute in place of ten: figures that are compared alone."""
    from tree_sway.simulation.rig import Rig

    monkeypatch.setitem(Rig.strength_curve.__kwdefaults__, 'seconds', 60.0)


@pytest.fixture
def installed():
    """Give a function that skips a test of a command whose modules are not installed."""

    from tree_sway.commands import cli

    def check(*words):
        table, group = cli._table(words[0])
        command = words[bool(group)]
        known = command in table or command not in ('lab', 'demo', 'listen', 'relay', 'record')
        if not known:
            pytest.skip(f'{command} is of a part that is not installed')
        for module in table[command].needs.split() if command in table else ():
            pytest.importorskip(module, reason=f'{command} needs {module}')
        if command == 'demo':
            pytest.importorskip('geometry_msgs', reason='ROS 2 is not installed')

    return check


def _differences(f, at, h=1e-3):
    """Jacobian of f by central differences of fourth order, the last axis along `at`."""
    columns = []
    for k in range(len(at)):
        d = np.zeros(len(at))
        d[k] = h
        near, far = f(at + d) - f(at - d), f(at + 2 * d) - f(at - 2 * d)
        columns.append((8.0 * near - far) / (12.0 * h))
    return np.stack(columns, axis=-1)


def _shared(function):
    name = function.__name__.lstrip('_')
    return pytest.fixture(scope='session', name=name)(lambda: function)


stem = _shared(drawn_trees.stem)
fork = _shared(drawn_trees.fork)
mirror_fork = _shared(drawn_trees.mirror_fork)
random_tree = _shared(drawn_trees.random_tree)
differences = _shared(_differences)


@pytest.fixture(scope='session')
def sketch():
    return drawn_trees.Sketch
