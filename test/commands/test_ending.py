# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import signal
import subprocess
import sys
import time

import pytest

from tree_sway.commands.ending import Ending

# What a compiler does: seconds in native code, with the interpreter's lock released.
DEAF = """
import hashlib, threading
from tree_sway.commands.ending import Ending
with Ending():
    threading.Timer(0.3, lambda: print("ready", flush=True)).start()
    hashlib.pbkdf2_hmac("sha256", b"a", b"b", 1_000_000_000)
"""


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
def test_a_process_deep_in_native_code_ends_in_time_and_well(number):
    process = subprocess.Popen([sys.executable, '-c', DEAF], stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline() == 'ready\n'
    begin = time.monotonic()
    process.send_signal(number)
    assert process.wait(30.0) == 0
    assert time.monotonic() - begin < 2.0


# What the middleware does while it leaves: a native call that keeps the interpreter's lock.
HOLDING = """
import ctypes
from tree_sway.commands.ending import Ending
with Ending() as ending:
    ending.look()
    print("ready", flush=True)
    while not ending.is_asked:
        pass
    ctypes.PyDLL(None).sleep(20)
"""


def test_a_process_that_holds_the_interpreter_ends_in_time():
    process = subprocess.Popen([sys.executable, '-c', HOLDING], stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline() == 'ready\n'
    begin = time.monotonic()
    process.send_signal(signal.SIGTERM)
    process.wait(30.0)
    assert time.monotonic() - begin < 2.5


def test_it_breaks_in_until_there_is_a_loop_that_looks():
    before = signal.getsignal(signal.SIGTERM)
    hook = sys.unraisablehook
    with Ending() as ending:
        signal.raise_signal(signal.SIGTERM)
        pytest.fail('it goes on')
    assert ending.is_asked
    sys.unraisablehook = hook
    assert signal.getsignal(signal.SIGTERM) is signal.SIG_IGN
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.default_int_handler)
    with Ending() as ending:
        ending.look()
        signal.raise_signal(signal.SIGTERM)
        signal.raise_signal(signal.SIGINT)
        assert ending.is_asked
    signal.signal(signal.SIGINT, signal.default_int_handler)
    signal.signal(signal.SIGTERM, before)


def test_what_is_broken_off_may_complain_of_anything():
    before, hook = signal.getsignal(signal.SIGTERM), sys.unraisablehook
    with Ending():
        try:
            signal.raise_signal(signal.SIGTERM)
        except KeyboardInterrupt:
            raise RuntimeError('no compiled object yet') from None
    signal.signal(signal.SIGTERM, before)
    signal.signal(signal.SIGINT, signal.default_int_handler)
    sys.unraisablehook = hook
    with pytest.raises(RuntimeError, match='a bug'), Ending():
        raise RuntimeError('a bug')


def test_without_a_signal_the_handlers_are_as_before():
    before = [signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)]
    with Ending() as ending:
        ending.look()
    assert [signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)] == before


def test_the_command_line_is_ready_for_ctrl_c_before_numpy_is_loaded():
    code = "import sys, tree_sway.commands.cli; sys.exit('numpy' in sys.modules)"
    assert subprocess.run([sys.executable, '-c', code]).returncode == 0


# What an executor does at the end of Python: it waits for its threads.
WAITED_FOR = """
from concurrent.futures import ThreadPoolExecutor
import time
from tree_sway.commands.ending import Ending
with Ending(is_last=True) as ending:
    ending.look()
    ThreadPoolExecutor().submit(time.sleep, 20)
    print("ready", flush=True)
    while not ending.is_asked:
        time.sleep(0.01)
"""


def test_python_is_not_waited_for_behind_the_last_one():
    command = [sys.executable, '-c', WAITED_FOR]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline() == 'ready\n'
    begin = time.monotonic()
    process.send_signal(signal.SIGINT)
    assert process.wait(30.0) == 0
    assert time.monotonic() - begin < 2.5
