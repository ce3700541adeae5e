# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import threading

import pytest

from tree_sway_ros.ros.process.progress import Progress


def test_a_stage_is_said_at_once_and_again_while_it_goes_on():
    said, more = [], threading.Event()

    def log(line):
        said.append(line)
        if 'so far' in line:
            more.set()

    with Progress(log, again=0.02) as progress:
        progress.stage('compiling')
        assert said == ['compiling']
        assert more.wait(10.0)
    assert said[1].startswith('compiling: 0 s so far')
    assert progress.elapsed > 0.0


def test_it_ends_with_what_failed_in_it():
    before = threading.active_count()
    with pytest.raises(ValueError, match='no'), Progress(print):
        raise ValueError('no')
    assert threading.active_count() == before
