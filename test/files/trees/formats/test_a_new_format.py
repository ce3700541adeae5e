# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A new format is one module in the folder of formats: tried by adding one."""

from pathlib import Path
import subprocess
import sys

import pytest

import tree_sway
from tree_sway.files.trees.tree_file import TREE_FORMATS

MODULE = '''
"""Poles: a line with height and diameter for each tree."""

from pathlib import Path

import numpy as np

from tree_sway.files.file_format import FileFormat
from tree_sway.files.text_file import read_lines
from tree_sway.files.table_file import parse_columns
from tree_sway.files.trees.cylinders.cylinders import Cylinders


def read_poles(path: Path) -> tuple[Cylinders, ...]:
    """Read poles whose feet are 2 m up."""
    table = parse_columns(read_lines(path)[1:], str(path), ["height", "diameter"])
    return tuple(
        Cylinders(np.array([[5.0 * row, 0, 2.0]]), np.array([[5.0 * row, 0, 2.0 + height]]),
                  np.array([[diameter, diameter]]), np.array([-1]), None, [table.where(row)])
        for row, (height, diameter) in enumerate(table.strict(["height", "diameter"]))
    )


FORMAT = FileFormat("poles", (".poles",), lambda head: head.startswith("POLES"), read_poles)
'''
USE = """
import sys
from tree_sway.files.trees.source import open_tree, open_scene
one = open_tree(sys.argv[1], species="oak")
print(one.tree.height, one.tree.start[0][2], one.species.key, len(open_scene(sys.argv[1]).trees))
"""


def test_one_file_is_all_it_takes(tmp_path):
    package = Path(tree_sway.__file__).parent
    (tmp_path / 'package').mkdir()
    copy = tmp_path / 'package' / 'tree_sway'
    # Links to every module but for one folder, which gets the new one.
    for source in sorted(package.rglob('*')):
        target = copy / source.relative_to(package)
        if source.is_dir():
            target.mkdir(parents=True, exist_ok=True)
        elif source.suffix in ('.py', '.json', '.yaml', '.csv', '.so'):
            target.parent.mkdir(parents=True, exist_ok=True)
            target.symlink_to(source)
    (copy / 'files/trees/formats/poles.py').write_text(MODULE)
    (tmp_path / 'two.poles').write_text('POLES\n6.0 0.2\n5.0 0.1\n')
    result = subprocess.run(
        [sys.executable, '-c', USE, str(tmp_path / 'two.poles')],
        cwd=tmp_path / 'package',
        env={'PYTHONPATH': str(tmp_path / 'package'), 'PATH': '', 'HOME': str(tmp_path)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert result.stderr == ''
    assert result.stdout.split() == ['6.0', '2.0', 'oak', '2']


def test_names_are_their_own():
    assert len({known.name for known in TREE_FORMATS}) == len(TREE_FORMATS) >= 9


@pytest.mark.parametrize('known', TREE_FORMATS, ids=lambda known: known.name)
def test_no_format_takes_what_is_nothing(known):
    for head in ('', '\n', '#', '\x00\x01', 'a,b,c\n1,2,3\n'):
        assert not known.recognise(head)
