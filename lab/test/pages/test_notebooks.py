# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A notebook holds all that its script does, and runs."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from tree_sway_lab.pages.command import EXAMPLES
from tree_sway_lab.pages.notebooks import notebook

FOLDER = Path(__file__).resolve().parents[3] / 'examples'
SCRIPT = '''\
# A comment above.
"""
A title.

    python examples/script.py

What it is for.

"""

import sys

FACTOR = 6


def doubled(number):
    """Twice a number."""
    return 2 * number


#: Told below.
FOUND = []


def main(name="7"):
    """Keep the answer."""
    FOUND.append(doubled(FACTOR) // 2 * int(name))


if __name__ == "__main__":
    main(*sys.argv[1:])
'''


def cells(text: str, kind: str) -> list[str]:
    document = json.loads(text)
    assert (document['nbformat'], document['nbformat_minor']) == (4, 5)
    assert len({cell['id'] for cell in document['cells']}) == len(document['cells'])
    return [''.join(cell['source']) for cell in document['cells'] if cell['cell_type'] == kind]


def test_cells_run_one_after_the_other_as_the_script_does(tmp_path: Path) -> None:
    script = tmp_path / 'script.py'
    script.write_text(SCRIPT, encoding='utf-8')
    text = notebook(script)
    heading = cells(text, 'markdown')
    assert heading == ['# A title\n\n    python examples/script.py\n\nWhat it is for.']
    code = cells(text, 'code')
    assert len(code) == 3
    names: dict[str, object] = {'__name__': '__main__'}
    for cell in code:
        exec(cell, names)
    assert names['FOUND'] == [42]


@pytest.mark.parametrize('name', EXAMPLES)
def test_the_examples_are_the_notebooks(name: str) -> None:
    kept = (FOLDER / f'{name}.ipynb').read_text(encoding='utf-8')
    assert kept == notebook(FOLDER / f'{name}.py')
    assert cells(kept, 'code')[-1] == 'main()'
