# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Files that are read in the process of a test, where a process of its own would read them."""

from __future__ import annotations

from collections.abc import Iterator
import io
import subprocess
from typing import Any

import pytest

from tree_sway.files import bounded


class InThisProcess:
    """Stands for `subprocess`: runs the program of `bounded` without a start, and unlimited."""

    TimeoutExpired = subprocess.TimeoutExpired

    def run(self, command: list[str], **_: Any) -> subprocess.CompletedProcess[bytes]:
        answer = io.BytesIO()
        try:
            bounded._answer(answer, *command[2:])
        except SystemExit as ended:
            return subprocess.CompletedProcess(command, 1, b'', str(ended.code).encode())
        return subprocess.CompletedProcess(command, 0, answer.getvalue(), b'')


@pytest.fixture
def readers_in_this_process() -> Iterator[None]:
    """Spare small files that are as their format says a process each: a damaged one may end it."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(bounded, 'subprocess', InThisProcess())
        yield
