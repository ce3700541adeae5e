# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A command that sets up several trees tells how many are ready."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from tree_sway.commands.cli import main


@pytest.mark.parametrize(
    ('command', 'module', 'suffix'),
    [
        (['convert'], 'tree_sway.files.commands.convert', '.html'),
        (['plot', '--seconds', '1'], 'tree_sway.pictures.commands.plot', '.png'),
    ],
)
def test_the_trees_of_a_stand_are_counted(
    tmp_path, monkeypatch, installed, command, module, suffix
):
    installed(command[0])
    told = []

    @contextmanager
    def counting(total: int, what: str) -> Iterator[object]:
        told.append(total)
        yield told.append

    monkeypatch.setattr(f'{module}.counting', counting)
    table = tmp_path / 'stand.csv'
    table.write_text('x,y,species,height\n0,0,oak,4\n9,0,birch,4\n')
    words = [*command, str(table), '--model', '3', '-o', str(tmp_path / f'out{suffix}')]
    assert main(words) == 0
    assert told[0] == told[-1] == 2
