# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Launch files as ``ros2 launch`` runs them, in a process of their own; only where launch is."""

import importlib.util
import os
from pathlib import Path
import re
import signal
import subprocess
import sys
import threading

import pytest

ROOT = Path(__file__).parents[2]
_spec = importlib.util.spec_from_file_location(
    'fixtures_of_nodes', ROOT / 'test' / 'nodes' / 'conftest.py'
)
nodes_conftest = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(nodes_conftest)
observer, tree_file = nodes_conftest.observer, nodes_conftest.tree_file

DEADLINE = 60.0
"""Four processes start and reduce their tree, on a busy machine."""
RUN = """
import sys
from launch import LaunchDescription, LaunchService
from launch.actions import IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
mode, path, *given = sys.argv[1:]
source = PythonLaunchDescriptionSource(path)
overrides = [word.split(":=", 1) for word in given]
service = LaunchService(argv=given, noninteractive=mode == "service")
action = IncludeLaunchDescription(source, launch_arguments=overrides)
service.include_launch_description(LaunchDescription([action]))
raise SystemExit(service.run())
"""
EXECUTABLE = """\
#!/bin/sh
exec {python} -c 'from tree_sway_ros.nodes.executables import {0} as f; raise SystemExit(f())' "$@"
"""


class Launched:
    """A launch that runs, and what it has said."""

    def __init__(self, path, overrides, environment, mode):
        self.said = []
        self._is_over = False
        self._more = threading.Condition()
        self.process = subprocess.Popen(
            [sys.executable, '-c', RUN, mode, str(path), *overrides],
            env=environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            start_new_session=True,
        )
        self._thread = threading.Thread(target=self._read, daemon=True)
        self._thread.start()

    def _read(self):
        for line in self.process.stdout:
            with self._more:
                self.said.append(line)
                self._more.notify_all()
        with self._more:
            self._is_over = True
            self._more.notify_all()

    @property
    def text(self):
        return ''.join(self.said)

    def until(self, pattern):
        """Wait for the match of a pattern in what is said."""
        with self._more:
            self._more.wait_for(lambda: self._is_over or re.search(pattern, self.text), DEADLINE)
            found = re.search(pattern, self.text)
        assert found, f"waited for '{pattern}':\n{self.text}"
        return found

    def end(self, number=signal.SIGINT):
        """End it as Ctrl-C in a terminal does, or as a service does."""
        os.killpg(self.process.pid, number)
        return self.ended()

    def ended(self):
        """Exit code, and all that was said."""
        code = self.process.wait(DEADLINE)
        self._thread.join(DEADLINE)
        return code, self.text

    def close(self):
        try:
            os.killpg(self.process.pid, signal.SIGKILL)
        except ProcessLookupError:
            pass
        self.process.wait()


@pytest.fixture
def prefix(tmp_path):
    """Make what ``colcon build`` installs, as far as launch looks at it."""
    from tree_sway_ros.nodes import executables

    made = tmp_path / 'prefix'
    index = made / 'share' / 'ament_index' / 'resource_index' / 'packages'
    share, programs = made / 'share' / 'tree_sway_ros', made / 'lib' / 'tree_sway_ros'
    for folder in (index, share, programs):
        folder.mkdir(parents=True)
    (index / 'tree_sway_ros').touch()
    for name in ('config', 'launch'):
        (share / name).symlink_to(ROOT / name)
    for name in ('anemometer', 'player', 'sensor', 'wind', 'solver', 'viewer'):
        assert hasattr(executables, name)
        (programs / name).write_text(EXECUTABLE.format(name, python=sys.executable))
        (programs / name).chmod(0o755)
    return made


@pytest.fixture
def environment(prefix, ros_environment):
    """Variables of a process that launches what is installed in `prefix`."""
    paths = [str(prefix), *os.environ.get('AMENT_PREFIX_PATH', '').split(os.pathsep)]
    return {
        **ros_environment,
        'AMENT_PREFIX_PATH': os.pathsep.join(filter(None, paths)),
        'PYTHONPATH': os.pathsep.join([str(ROOT), *filter(None, sys.path)]),
        'PYTHONUNBUFFERED': '1',
    }


@pytest.fixture
def launched(environment):
    """Launch a file by its name, with arguments: ``'sway.launch.py', tree='goldcrest'``."""
    pytest.importorskip('launch_ros', reason='launch_ros is not installed')
    made, variables = [], environment

    def start(path, mode='terminal', environment=None, **overrides):
        words = [f'{name}:={value}' for name, value in overrides.items()]
        whole = {**variables, **(environment or {})}
        made.append(Launched(ROOT / 'launch' / path, words, whole, mode))
        return made[-1]

    yield start
    for each in made:
        each.close()
