# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Variables of a MATLAB file, read by scipy (versions 4 to 7) or h5py (7.3) in a process of its own.

A few bytes can claim gigabytes, nest without end, or end the process that the libraries run in; so
that process is another one, with so much memory and time and no more.
"""

from __future__ import annotations

import io
import os
from pathlib import Path
import subprocess
import sys
from typing import Any

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.errors import FormatError, MissingDependencyError
from tree_sway.files.text_file import read_bytes
from tree_sway.files.trees.cylinders import mat_child

Variables = dict[str, Any]
"""Arrays by name; structs as dictionaries, several of them in one with numbers for names."""


def looks_like_mat(head: str) -> bool:
    """Whether the beginning of a file is that of a MATLAB file."""
    return head.startswith(('MATLAB', '\ufffdHDF\r\n\x1a\n'))


def read_mat(path: Path) -> Variables:
    """
    Read the arrays of numbers of a MATLAB file, those of structs and cells in dictionaries.

    Raises
    ------
    FormatError
        Not a MATLAB file, damaged, or one that takes too much memory or time.
    MissingDependencyError
        If it is of version 7.3 and h5py is not installed.

    """
    read_bytes(path, at_most=1)
    command = [sys.executable, mat_child.__file__, str(path.absolute())]
    environment = {**os.environ, 'OPENBLAS_NUM_THREADS': '1'}  # each takes memory of its own
    budget = f'{mat_child.MEMORY >> 20} MiB of memory or {mat_child.SECONDS} s'
    try:
        ended = subprocess.run(
            command, capture_output=True, env=environment, timeout=2 * mat_child.SECONDS
        )
        reason = ended.stderr.decode('utf-8', 'replace').strip().split('\n')[-1]
    except subprocess.TimeoutExpired:
        ended, reason = None, ''
    if reason == 'no module h5py':
        raise MissingDependencyError(
            'a MATLAB file of version 7.3 needs h5py',
            where=str(path),
            cure='pip install h5py, or save it with the option -v7',
        )
    if ended is None or ended.returncode:
        is_large = ended is None or ended.returncode < 0 or 'MemoryError' in reason
        what = f'it takes more than {budget}, or is damaged' if is_large else reason
        raise FormatError(
            f'not a MATLAB file that can be read: {what}', where=str(path), cure='save it again'
        )
    with np.load(io.BytesIO(ended.stdout)) as arrays:
        return _nested({name: arrays[name] for name in arrays.files})


def _nested(arrays: dict[str, Any]) -> Variables:
    """Dictionaries in dictionaries from paths."""
    variables: Variables = {}
    for name, array in arrays.items():
        *above, last = name.split('/')
        place = variables
        for step in above:
            place = place.setdefault(step, {})
        place[last] = array
    return variables


def numbers(value: Any, name: str) -> Floats:
    """Return a variable as numbers, without axes of length 1; a `FormatError` for others."""
    if not isinstance(value, np.ndarray):
        raise FormatError(f"'{name}' is not numeric")
    return value.astype(np.float64).squeeze()
