# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import os
import subprocess
import sys
import threading
import time

import pytest

# An int in a float field can end the process: have every field checked.
os.environ['ROS_PYTHON_CHECK_FIELDS'] = '1'
os.environ.setdefault('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')

DEADLINE = 60.0
ASK_AGAIN = 2.0
"""Time [s] without a response after which a service is asked again."""

TREE = """\
segment,parent,branch,x0,y0,z0,x1,y1,z1,d0,d1
0,-1,0,0,0,0,0,0,.5,.02,.018
1,0,0,0,0,.5,0,0,1,.018,.014
2,1,0,0,0,1,0,0,1.5,.014,.008
3,1,1,0,0,1,.3,0,1.3,.006,.004
4,1,2,0,0,1,0,.3,1.3,.006,.004
5,1,3,0,0,1,-.3,0,1.3,.006,.004
6,1,4,0,0,1,0,-.3,1.3,.006,.004
"""


START = 'from tree_sway_ros.nodes.executables import {0}; raise SystemExit({0}())'


class Observer:
    """A node of a test's own, in a context of its own: another process as far as DDS goes."""

    def __init__(self, domain):
        import rclpy
        from rclpy.context import Context
        from rclpy.executors import SingleThreadedExecutor

        self.context = Context()
        rclpy.init(args=[], context=self.context, domain_id=domain)
        self.node = rclpy.create_node('observer', context=self.context)
        self._executor = SingleThreadedExecutor(context=self.context)
        self._executor.add_node(self.node)
        self._more = threading.Condition()
        self._clients = {}
        self._closing = False
        self._thread = threading.Thread(target=self._spin, daemon=True)
        self._thread.start()

    def listen(self, topic, kind=None, name=None, raw=False, depth=None):
        """Return a list that fills with the messages of a topic of the table."""
        from tree_sway_ros.process.topics import message_class, qos_profile

        messages = []

        def take(message):
            with self._more:
                messages.append(message)
                self._more.notify_all()

        kind = kind or message_class(topic)
        qos = qos_profile(topic)
        qos.depth = depth or qos.depth
        self.node.create_subscription(kind, name or topic.name, take, qos, raw=raw)
        self._executor.wake()
        return messages

    def publisher(self, topic, kind=None, name=None):
        """Return a publisher on a topic of the table, once it has a subscriber."""
        from tree_sway_ros.process.topics import message_class, qos_profile

        made = self.node.create_publisher(
            kind or message_class(topic), name or topic.name, qos_profile(topic)
        )
        self.until(lambda: made.get_subscription_count() > 0, 'a subscriber')
        return made

    def call(self, kind, name, request):
        """
        Return the response of a service that may be asked twice for the same.

        A server that has not yet found the client drops its response: the same client asks again.
        """
        if name not in self._clients:
            self._clients[name] = self.node.create_client(kind, name)
        client = self._clients[name]
        self.until(client.service_is_ready, name)
        asked = []

        def answered():
            if not asked or time.monotonic() - asked[-1][0] > ASK_AGAIN:
                asked.append((time.monotonic(), client.call_async(request)))
            return any(future.done() for _, future in asked)

        self.until(answered, f'a response of {name}')
        return next(future.result() for _, future in asked if future.done())

    def until(self, condition, what, deadline=DEADLINE, poll=0.02):
        """Wait until something is true; fail after the deadline."""
        end = time.monotonic() + deadline
        with self._more:
            while not condition():
                assert time.monotonic() < end, f'waited {deadline} s for {what}'
                self._more.wait(poll)

    def close(self):
        self._closing = True
        self._executor.wake()
        self._thread.join(5.0)
        self._executor.shutdown(1.0)
        self.node.destroy_node()
        self.context.try_shutdown()

    def _spin(self):
        while not self._closing:
            self._executor.spin_once(timeout_sec=0.2)


@pytest.fixture
def observer(domain):
    made = Observer(domain)
    yield made
    made.close()


@pytest.fixture
def compose(domain):
    """Start nodes in this process, each by its name and parameters: ``solver={...}``."""
    from tree_sway_ros.process.composition import Composition

    made = []

    def start(namespace='', **parameters):
        made.append(Composition(parameters, namespace=namespace, domain_id=domain))
        return made[-1]

    yield start
    try:
        for composition in made:
            composition.check()
            for node in composition.nodes:
                assert not node.guard.count, node.guard.latest
    finally:
        for composition in made:
            composition.close()


@pytest.fixture
def tree_file(tmp_path):
    path = tmp_path / 'sapling.csv'
    path.write_text(TREE)
    return str(path)


@pytest.fixture
def statuses(observer):
    """Give the newest status of each name on /diagnostics, for names like ``'solver: wind'``."""
    from tree_sway_ros.process.topics import DIAGNOSTICS

    arrays = observer.listen(DIAGNOSTICS)

    def newest(name):
        found = [s for array in list(arrays) for s in array.status if s.name == name]
        return found[-1] if found else None

    return newest


@pytest.fixture
def level(statuses):
    """Newest level of a name on /diagnostics, None before the first."""

    def newest(name):
        status = statuses(name)
        return None if status is None else status.level[0]

    return newest


@pytest.fixture
def run(domain):
    """Start an executable in a process of its own."""
    processes = []

    def start(name, *parameters, remap=(), before='', **environment):
        arguments = [part for p in parameters for part in ('-p', p)]
        arguments += [part for r in remap for part in ('-r', r)]
        process = subprocess.Popen(
            [sys.executable, '-c', before + START.format(name), '--ros-args', *arguments],
            env=os.environ | {'ROS_DOMAIN_ID': str(domain)} | environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        processes.append(process)
        return process

    yield start
    for process in processes:
        process.kill()
        process.communicate()
