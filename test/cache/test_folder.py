# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Nobody but the user puts a file where it is read: real folders, modes and links."""

from __future__ import annotations

import os
from pathlib import Path
import tempfile
import time

import pytest

from tree_sway.cache import folder as module
from tree_sway.cache.folder import cache_folder, read_own, why_unsafe, write_own

pytestmark = pytest.mark.skipif(not hasattr(os, 'getuid'), reason='modes are those of POSIX')


@pytest.fixture
def place(tmp_path: Path) -> Path:
    """Return a folder that is safe by itself and by all above it."""
    if why_unsafe(tmp_path):
        pytest.skip(why_unsafe(tmp_path))
    folder = tmp_path / 'models'
    folder.mkdir(mode=0o700)
    return folder


def chosen(asked: Path, monkeypatch: pytest.MonkeyPatch) -> Path | None:
    """Return the folder that a program takes which is asked to take a given one."""
    monkeypatch.setenv('TREE_SWAY_CACHE', str(asked))
    monkeypatch.setattr(module, '_said', set())
    cache_folder.cache_clear()
    try:
        return cache_folder()
    finally:
        cache_folder.cache_clear()


@pytest.mark.parametrize('mode', [0o700, 0o755, 0o500])
def test_a_folder_that_others_cannot_write_is_safe(place: Path, mode: int) -> None:
    place.chmod(mode)
    assert why_unsafe(place) == ''


@pytest.mark.parametrize('mode', [0o777, 0o770, 0o722, 0o1777])
def test_a_folder_that_others_may_write_is_refused(
    place: Path, mode: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    place.chmod(mode)
    with pytest.warns(RuntimeWarning, match=r'others may write into .*; chmod go-w'):
        assert chosen(place, monkeypatch) != place


def test_so_is_one_below_a_folder_that_others_may_write(
    place: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    inner = place / 'inner'
    inner.mkdir(mode=0o700)
    place.chmod(0o777)
    with pytest.warns(RuntimeWarning, match='others may write'):
        assert chosen(inner, monkeypatch) != inner
    place.chmod(0o1777)  # as /tmp: no user removes the files of another
    assert chosen(inner, monkeypatch) == inner


@pytest.mark.skipif(not hasattr(os, 'getuid') or os.getuid() != 0, reason='chown needs root')
def test_a_folder_of_another_user_is_refused(place: Path) -> None:
    os.chown(place, 12345, -1)
    assert 'belongs to other users' in why_unsafe(place)
    inner = place / 'inner'
    inner.mkdir(mode=0o700)
    assert 'belongs to other users' in why_unsafe(inner)


def test_a_link_to_the_folder_is_resolved_once(
    place: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    link = place.parent / 'link'
    link.symlink_to(place)
    assert chosen(link, monkeypatch) == place.resolve()


def test_missing_folders_are_made_for_the_user_alone(
    place: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = os.umask(0)
    try:
        made = chosen(place / 'a' / 'b', monkeypatch)
    finally:
        os.umask(before)
    assert made == place / 'a' / 'b'
    assert {each.stat().st_mode & 0o777 for each in (made, made.parent)} == {0o700}


def test_a_file_is_read_unless_others_may_have_written_it(place: Path) -> None:
    path = place / 'one.npz'
    write_own(path, b'model')
    assert path.stat().st_mode & 0o777 == 0o600
    assert read_own(path) == b'model'
    link = place / 'link.npz'
    link.symlink_to(path)
    with pytest.raises(OSError, match='link'):
        read_own(link)
    for mode in (0o620, 0o602):
        path.chmod(mode)
        with pytest.raises(PermissionError, match='others may have written'):
            read_own(path)
    if os.getuid() == 0:
        path.chmod(0o600)
        os.chown(path, 12345, -1)
        with pytest.raises(PermissionError, match='others may have written'):
            read_own(path)


def test_a_machine_that_is_read_only_has_none(monkeypatch: pytest.MonkeyPatch) -> None:
    def nowhere() -> str:
        raise FileNotFoundError('No usable temporary directory found')

    monkeypatch.setattr(tempfile, 'gettempdir', nowhere)
    monkeypatch.setenv('XDG_CACHE_HOME', '/proc/none')
    with pytest.warns(RuntimeWarning, match='no folder for prepared models can be written'):
        assert chosen(Path('/proc/none/models'), monkeypatch) is None


@pytest.mark.parametrize('kind', ['file', 'circle', 'long', 'nowhere'])
def test_a_given_folder_that_cannot_be_used_is_told_and_replaced(
    place: Path, monkeypatch: pytest.MonkeyPatch, kind: str
) -> None:
    given = place / 'given'
    if kind == 'file':
        given.write_text('')
    elif kind == 'circle':
        given.symlink_to(given)
    elif kind == 'long':
        given = place / ('a' * 300)
    else:
        given = Path('/proc/none/models')
    monkeypatch.setenv('XDG_CACHE_HOME', str(place))
    monkeypatch.setattr(module, '_said', set())
    with pytest.warns(RuntimeWarning, match='which was given') as told:
        assert chosen(given, monkeypatch) == place / 'tree_sway'
    assert len(told) == 1


def test_what_a_killed_process_left_is_removed(
    place: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    old = time.time() - 3660.0
    for name in ('left.part', 'other.txt'):
        write_own(place / name, b'')
        os.utime(place / name, (old, old))
    write_own(place / 'new.part', b'')
    assert chosen(place, monkeypatch) == place
    assert {each.name for each in place.iterdir()} == {'new.part', 'other.txt'}
