# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A notebook holds all that its script does, and runs."""

from __future__ import annotations

import json
from pathlib import Path
import re
from typing import Any

import pytest

pytest.importorskip('matplotlib', reason='matplotlib is not installed')

from tree_sway_lab.pages.command import EXAMPLES  # noqa: E402
from tree_sway_lab.pages.notebooks import notebook, with_outputs  # noqa: E402

FOLDER = Path(__file__).resolve().parents[3] / 'examples'
NUMBER = r'[-+]?\d+(?:\.\d+)?'
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


#: Described below.
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
    stored = (FOLDER / f'{name}.ipynb').read_text(encoding='utf-8')
    assert stored == notebook(FOLDER / f'{name}.py')
    assert 'main()' in cells(stored, 'code')[-2:]
    outputs = outputs_of_main(stored)
    assert any(output['output_type'] == 'stream' for output in outputs)
    assert any('image/png' in output.get('data', {}) for output in outputs)


def outputs_of_main(text: str) -> list[dict[str, Any]]:
    every = json.loads(text)['cells']
    (outputs,) = [cell['outputs'] for cell in every if cell['source'] == ['main()']]
    return outputs  # type: ignore[no-any-return]


def printed(text: str) -> tuple[list[str], list[float]]:
    """Words and numbers that the call of main printed."""
    said = ''.join(''.join(each.get('text', [])) for each in outputs_of_main(text))
    return re.split(NUMBER, said), [float(number) for number in re.findall(NUMBER, said)]


@pytest.mark.parametrize(
    'name',
    [
        pytest.param(name, marks=[pytest.mark.long] * (name != 'sheltered_and_open'))
        for name in EXAMPLES
    ],
)
def test_what_they_show_is_what_they_print(name: str) -> None:
    stored = (FOLDER / f'{name}.ipynb').read_text(encoding='utf-8')
    words, numbers = printed(with_outputs(stored))
    assert words == printed(stored)[0]
    assert numbers == pytest.approx(printed(stored)[1], rel=0.02, abs=0.01)


def test_a_notebook_keeps_its_outputs_until_its_cells_change(tmp_path: Path) -> None:
    script = tmp_path / 'script.py'
    script.write_text(SCRIPT + '\n', encoding='utf-8')
    run = with_outputs(notebook(script).replace('FOUND.append(', 'print('))
    said = ''.join(''.join(o['text']) for o in outputs_of_main(run))
    assert said == '42\n'
    beside = script.with_suffix('.ipynb')
    beside.write_text(with_outputs(notebook(script)).replace('"outputs": []', '"outputs": [1]'))
    assert '"outputs": [\n    1\n   ]' in notebook(script)
    script.write_text(SCRIPT.replace('FACTOR = 6', 'FACTOR = 7'), encoding='utf-8')
    assert '    1\n' not in notebook(script)
