# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
from hypothesis import given
from hypothesis import strategies as st

from tree_sway.live.transports.lines import Lines, LONGEST


def test_lines_come_out_however_they_were_cut():
    lines = Lines()
    assert list(lines.feed(b'$WIMWV,1')) == []
    assert list(lines.feed(b'2\r\n\r\n$WI')) == [b'$WIMWV,12']
    assert list(lines.feed(b'MWD\n')) == [b'$WIMWD']


def test_what_is_too_long_is_dropped_and_the_next_line_is_read():
    lines = Lines()
    for _ in range(10):
        assert list(lines.feed(b'x' * LONGEST)) == []
    assert list(lines.feed(b'\n$WIMWD\n')) == [b'$WIMWD']
    assert lines.dropped == 1


@given(st.lists(st.binary(max_size=40_000), max_size=20))
def test_whatever_comes_memory_is_bounded(chunks):
    lines = Lines()
    for chunk in chunks:
        assert all(0 < len(line) <= LONGEST for line in lines.feed(chunk))
        assert len(lines._begun) <= LONGEST
