# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The tasks of ``doc/tasks.md`` do what the page says, as typed."""

from __future__ import annotations

import os
from pathlib import Path
import re
import runpy
from types import SimpleNamespace

import pytest

timed = SimpleNamespace(**runpy.run_path(str(Path(__file__).with_name('time_tasks.py'))))
TASKS = timed.tasks()
ON_ROS = {5, 10, 11}
NEEDS = {6: 'aiohttp', 7: 'pyarrow', 11: 'serial', 13: 'imageio_ffmpeg', 14: 'matplotlib'}


each_task = pytest.mark.parametrize(
    'task',
    [
        pytest.param(each, id=each.title, marks=[pytest.mark.ros] * (each.number in ON_ROS))
        for each in TASKS
    ],
)


@pytest.mark.long
@each_task
def test_it_does_what_the_page_says(
    task: SimpleNamespace, tmp_path: Path, request: pytest.FixtureRequest
) -> None:
    look(task, tmp_path, request)


@pytest.mark.long
@each_task
def test_it_does_so_in_short(
    task: SimpleNamespace, tmp_path: Path, request: pytest.FixtureRequest
) -> None:
    look(timed.in_short(task), tmp_path, request)


def look(task: SimpleNamespace, folder: Path, request: pytest.FixtureRequest) -> None:
    """Run a task in a folder, and look for its result."""
    if task.number in NEEDS:
        pytest.importorskip(NEEDS[task.number], reason=f'needs {NEEDS[task.number]}')
    on_ros = task.number in ON_ROS
    environment = request.getfixturevalue('ros_environment') if on_ros else dict(os.environ)
    _, said = timed.run(task, folder, environment)
    assert timed.result_of(task, said)


def test_the_table_has_a_row_of_each_task() -> None:
    rows = re.findall(r'^\| (\d+)\. (.*?) \| (\d+) \| ', timed.PAGE.read_text(), re.MULTILINE)
    assert [(int(number), title) for number, title, _ in rows] == [
        (task.number, task.title) for task in TASKS
    ]
    assert set(timed.RESULTS) == {task.number for task in TASKS}
