# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import os
from pathlib import Path
import platform
import signal
import subprocess
import sys
import time
import types
from xml.etree import ElementTree

import pytest

from tree_sway.errors import MissingDependencyError, ParameterError, TransportError
from tree_sway_ros.process import spin


class FakeRclpy(types.ModuleType):
    """As much of rclpy as a process's life needs."""

    def __init__(self, monkeypatch):
        super().__init__('rclpy')
        self.calls = []
        self.is_ok = True
        self.on_spin = lambda: None
        executors = types.ModuleType('rclpy.executors')
        executors.ExternalShutdownException = type('ExternalShutdownException', (Exception,), {})
        executors.SingleThreadedExecutor = lambda: self
        self.signals = types.SimpleNamespace(SignalHandlerOptions=types.SimpleNamespace(NO=0))
        self.shutdown_error = executors.ExternalShutdownException
        monkeypatch.setitem(sys.modules, 'rclpy', self)
        monkeypatch.setitem(sys.modules, 'rclpy.executors', executors)

    def init(self, args=None, signal_handler_options=None):
        self.calls.append('init')

    def ok(self):
        return self.is_ok

    def add_node(self, node):
        self.calls.append('add')

    def spin_once(self, timeout_sec):
        self.calls.append('spin')
        self.on_spin()

    def try_shutdown(self):
        self.calls.append('shutdown')


class FakeNode:
    """What `spin` asks of a node."""

    def __init__(self):
        self.failure = None
        self.is_done = False
        self.closed = 0

    def close(self):
        self.closed += 1


@pytest.fixture(autouse=True)
def handlers():
    """Restore the handlers: a process that was asked to end ignores signals."""
    before = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    yield
    for number, handler in before.items():
        signal.signal(number, handler)


@pytest.fixture
def rclpy(monkeypatch):
    return FakeRclpy(monkeypatch)


@pytest.fixture
def node(monkeypatch):
    made = FakeNode()
    module = types.ModuleType('fake_nodes')
    module.Node = lambda: made
    module.Broken = lambda: (_ for _ in ()).throw(ParameterError('a bad value', cure='mend it'))
    monkeypatch.setitem(sys.modules, 'fake_nodes', module)
    return made


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
def test_it_ends_amid_the_making_of_its_node(rclpy, node, monkeypatch, number):
    def make():
        signal.raise_signal(number)
        time.sleep(10.0)

    monkeypatch.setattr(sys.modules['fake_nodes'], 'Node', make)
    begin = time.monotonic()
    assert spin.run('fake_nodes', 'Node') == 0
    assert time.monotonic() - begin < 2.0
    assert rclpy.calls == ['init', 'shutdown']
    assert signal.getsignal(number) is signal.SIG_IGN


def raises(error):
    def act():
        raise error

    return act


def test_it_ends_when_the_node_is_done(rclpy, node):
    rclpy.on_spin = lambda: setattr(node, 'is_done', True)
    assert spin.run('fake_nodes', 'Node') == 0
    assert rclpy.calls == ['init', 'add', 'spin', 'shutdown']
    assert node.closed == 1


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM, None])
def test_it_ends_well_when_asked_to(rclpy, node, number):
    gone = raises(rclpy.shutdown_error())
    rclpy.on_spin = gone if number is None else lambda: signal.raise_signal(number)
    assert spin.run('fake_nodes', 'Node') == 0
    assert node.closed == 1


def test_any_other_error_comes_out(rclpy, node):
    rclpy.on_spin = raises(RuntimeError('a bug'))
    with pytest.raises(RuntimeError, match='a bug'):
        spin.run('fake_nodes', 'Node')
    assert rclpy.calls[-1] == 'shutdown'


def test_what_a_thread_died_of_ends_the_node(rclpy, node, capsys):
    rclpy.on_spin = lambda: setattr(node, 'failure', ParameterError('time went away'))
    assert spin.run('fake_nodes', 'Node') == 2
    assert 'time went away' in capsys.readouterr().err


def test_an_error_of_ours_is_one_line(rclpy, node, capsys):
    assert spin.run('fake_nodes', 'Broken') == 2
    assert capsys.readouterr().err == 'fake_nodes: a bad value; mend it\n'


@pytest.mark.parametrize('own', [(), ('FASTRTPS_DEFAULT_PROFILES_FILE',)])
@pytest.mark.parametrize('before', ['', str(Path(spin.__file__).with_name('discovery.xml'))])
def test_nodes_announce_themselves_often_and_hear_by_udp_unless_a_profile_is_named(
    rclpy, node, monkeypatch, own, before
):
    names = ('FASTRTPS_DEFAULT_PROFILES_FILE', 'FASTDDS_DEFAULT_PROFILES_FILE')
    for name in names:
        monkeypatch.setenv(name, 'of_my_own.xml' if name in own else before)
    rclpy.on_spin = lambda: setattr(node, 'is_done', True)
    assert spin.run('fake_nodes', 'Node') == 0
    if own:
        assert [os.environ[name] for name in names] == ['of_my_own.xml', before]
        return
    (file,) = {os.environ[name] for name in names}
    space = '{http://www.eprosima.com/XMLSchemas/fastRTPS_Profiles}'
    profile = ElementTree.parse(file).getroot()
    period = profile.find(f'.//{space}leaseAnnouncement')
    assert [each.text for each in period] == ['0', '300000000']
    (place,) = profile.iterfind(f'.//{space}defaultUnicastLocatorList/{space}locator/*')
    assert place.tag == f'{space}udpv4'


FREED = """
import ctypes, types
from tree_sway_ros.process import spin
spin.init(types.SimpleNamespace(init=lambda args: None))
libc = ctypes.CDLL(None)
libc.malloc.restype, libc.malloc.argtypes = ctypes.c_void_p, [ctypes.c_size_t]
libc.free.argtypes = [ctypes.c_void_p]
libc.free(libc.malloc(8 << 20))
print(ctypes.c_size_t.from_address(libc.malloc(4 << 20) - 8).value & 2)
"""
"""Whether glibc maps a block of 4 MB, to be given back when it is freed, once it freed 8 MB."""


@pytest.mark.skipif(platform.libc_ver()[0] != 'glibc', reason='of glibc alone')
def test_large_blocks_go_back_to_the_system_after_larger_ones():
    """Without the call glibc keeps them, but where another mapping stops its heap from growing."""
    result = subprocess.run(
        [sys.executable, '-c', FREED], capture_output=True, text=True, check=True
    )
    assert int(result.stdout) == 2


def test_no_ros_is_one_line(monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, 'rclpy', None)
    assert spin.run('fake_nodes', 'Node') == 2
    assert len(capsys.readouterr().err.splitlines()) == 1
    with pytest.raises(MissingDependencyError, match=r'in_venv\.py'):
        spin.require_rclpy()


@pytest.mark.parametrize('domain', ['-1', '233', 'abc', '1.5'])
def test_a_domain_that_is_none_is_named(rclpy, monkeypatch, domain):
    monkeypatch.setenv('ROS_DOMAIN_ID', domain)
    with pytest.raises(TransportError, match=f'ROS_DOMAIN_ID={domain} is no domain'):
        spin.init(rclpy)


def test_a_start_that_fails_is_one_line(rclpy, monkeypatch):
    monkeypatch.setattr(
        rclpy, 'init', lambda args, **_: raises(RuntimeError('no rmw\nat line 3'))()
    )
    with pytest.raises(TransportError, match=r'ROS 2 cannot start: no rmw$'):
        spin.init(rclpy)


@pytest.mark.ros
@pytest.mark.skipif(not sys.platform.startswith('linux'), reason='writes to /proc')
def test_a_machine_that_is_read_only_is_one_line_with_the_cure():
    pytest.importorskip('rclpy.node', reason='ROS 2 is not installed')
    start = 'from tree_sway_ros.nodes.executables import wind; raise SystemExit(wind())'
    ended = subprocess.run(
        [sys.executable, '-c', start], env={**os.environ, 'ROS_LOG_DIR': '/proc/nowhere'},
        capture_output=True, text=True, timeout=60, check=False,
    )  # fmt: skip
    assert ended.returncode == 2
    assert ended.stderr.count('\n') == 1
    assert '/proc/nowhere' in ended.stderr
    assert 'set ROS_LOG_DIR to a writable folder' in ended.stderr


def test_a_domain_that_cannot_be_joined_is_named(monkeypatch):
    monkeypatch.setenv('ROS_DOMAIN_ID', '7')
    error = type('RCLError', (RuntimeError,), {})('failed to create domain participant')
    with pytest.raises(TransportError, match='no node in domain 7: failed to create'):
        spin.create(raises(error))
    unsafe = type('RCLError', (RuntimeError,), {})('error creating node: no security libraries')
    with pytest.raises(TransportError, match='no security libraries; '):
        spin.create(raises(unsafe))
    with pytest.raises(RuntimeError, match='a bug'):
        spin.create(raises(RuntimeError('a bug')))


@pytest.mark.parametrize(
    'error',
    [
        type('InvalidNamespaceException', (ValueError,), {})("Invalid namespace: no:\n  'a b'"),
        type('RCLError', (RuntimeError,), {})('error creating node: invalid node namespace: no'),
    ],
)
def test_a_bad_namespace_is_one_line(error):
    with pytest.raises(
        TransportError, match=r"namespace 'a b': .*names have letters, digits and _"
    ) as failure:
        spin.create(lambda **_: raises(error)(), namespace='a b')
    assert len(str(failure.value).splitlines()) == 1
