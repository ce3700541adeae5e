# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import os
from pathlib import Path
import stat

import pytest

from tree_sway.errors import FormatError
from tree_sway.files.atomic_file import whole_file, write_text_whole
from tree_sway.files.paths import path_of
from tree_sway.files.text_file import read_text


def written_until(file, error):
    with whole_file(file) as partial:
        partial.write_text('half')
        raise error


def test_a_failure_keeps_what_was_there(tmp_path):
    file = tmp_path / 'tree.yaml'
    file.write_text('old')
    with pytest.raises(RecursionError):
        written_until(file, RecursionError('too deep'))
    assert file.read_text() == 'old'
    assert os.listdir(tmp_path) == ['tree.yaml']


def test_a_full_disk_is_one_line_and_leaves_nothing(tmp_path):
    with pytest.raises(FormatError, match=r'tree.yaml: cannot be written: No space left'):
        written_until(tmp_path / 'tree.yaml', OSError(28, os.strerror(28)))
    assert os.listdir(tmp_path) == []


def test_links_and_modes_stay(tmp_path):
    file, link = tmp_path / 'a', tmp_path / 'b'
    file.write_text('old')
    file.chmod(0o640)
    link.symlink_to(file)
    write_text_whole(link, 'new')
    assert link.is_symlink()
    assert file.read_text() == 'new'
    assert stat.S_IMODE(file.stat().st_mode) == 0o640
    write_text_whole(tmp_path / 'c', 'new')
    usual = tmp_path / 'd'
    usual.touch()
    assert (tmp_path / 'c').stat().st_mode == usual.stat().st_mode


def test_a_device_is_written_to_directly():
    write_text_whole('/dev/null', 'text')
    assert stat.S_ISCHR(Path('/dev/null').stat().st_mode)


@pytest.mark.parametrize(
    ('name', 'message'),
    [
        ('~nosuchuser/tree.yaml', "no user '~nosuchuser'; write the folder in full"),
        ('x' * 300, 'not a path: File name too long'),
        ('a\0b', 'not a path: .*null'),
        ('a\ud800', 'not a path: .*surrogates not allowed'),
    ],
)
def test_names_that_are_no_path(tmp_path, name, message):
    for action in (path_of, read_text_of(tmp_path), lambda path: write_text_whole(path, '')):
        with pytest.raises(FormatError) as caught:
            action(name)
        assert '\n' not in str(caught.value)
    with pytest.raises(FormatError, match=message):
        path_of(name)


def read_text_of(folder):
    return lambda name: read_text(folder / name)


def test_home_and_names_outside_ascii(tmp_path, monkeypatch):
    monkeypatch.setenv('HOME', str(tmp_path))
    write_text_whole('~/Bäume-木.txt', 'x')
    assert read_text(tmp_path / 'Bäume-木.txt') == 'x'
