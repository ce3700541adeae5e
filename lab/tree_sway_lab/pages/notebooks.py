# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Notebooks of the example scripts, so that each is written once and opens either way."""

from __future__ import annotations

import ast
from base64 import b64encode
from contextlib import redirect_stdout
import io
import json
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

PICTURES = '%matplotlib inline'
"""First line of a notebook with pictures; nothing to Python."""


def notebook(script: Path) -> str:
    """
    Turn an example script into a notebook.

    Its docstring becomes the heading and the text above, every function a cell with the constants
    before it, and the calls of ``main`` and, where there is one, ``slider`` the last cells.
    Outputs are those of the notebook beside the script, where its cells are the same.

    Parameters
    ----------
    script
        Python that ends by calling its function ``main``, which needs no arguments.

    Returns
    -------
    str
        A notebook of format 4.5.

    """
    source = script.read_text(encoding='utf-8')
    module = ast.parse(source)
    title, _, text = (ast.get_docstring(module) or script.stem).partition('\n')
    cells = [_cell('markdown', f'# {title.rstrip(".")}\n\n{text.strip(chr(10))}')]
    lines, begin = source.splitlines(), (module.body[0].end_lineno or 0)
    *body, _ = module.body  # less the call of main with the words of a command line
    used = {n.id for node in body for n in ast.walk(node) if isinstance(n, ast.Name)}
    for node in body:
        if isinstance(node, ast.Import) and not used & {n.asname or n.name for n in node.names}:
            begin = node.end_lineno or begin
        elif isinstance(node, ast.FunctionDef):
            cells.append(_cell('code', '\n'.join(lines[begin : node.end_lineno]).strip()))
            begin = node.end_lineno or begin
    if any(isinstance(n, ast.ImportFrom) and 'matplotlib' in str(n.module) for n in body):
        cells.insert(1, _cell('code', PICTURES))
    names = {node.name for node in body if isinstance(node, ast.FunctionDef)}
    cells += [_cell('code', f'{name}()') for name in ('main', 'slider') if name in names]
    beside = script.with_suffix('.ipynb')
    before = json.loads(beside.read_text(encoding='utf-8'))['cells'] if beside.is_file() else []
    if [cell['source'] for cell in before] == [cell['source'] for cell in cells]:
        for cell, old in zip(cells, before, strict=True):
            cell.update({key: old[key] for key in cell if key == 'outputs'})
    kernel = {'display_name': 'Python 3', 'language': 'python', 'name': 'python3'}
    whole = {
        'cells': [{'id': f'cell-{number}', **cell} for number, cell in enumerate(cells)],
        'metadata': {'kernelspec': kernel},
        'nbformat': 4,
        'nbformat_minor': 5,
    }
    return json.dumps(whole, indent=1, ensure_ascii=False) + '\n'


def with_outputs(text: str) -> str:
    """Run the cells of a notebook, and save what they print and draw."""
    whole = json.loads(text)
    names: dict[str, Any] = {'__name__': '__main__'}
    for cell in whole['cells']:
        if cell['cell_type'] == 'code':
            cell['outputs'] = _outputs_of(''.join(cell['source']), names)
    return json.dumps(whole, indent=1, ensure_ascii=False) + '\n'


def _outputs_of(source: str, names: dict[str, Any]) -> list[dict[str, Any]]:
    """Run a cell; what it printed, and its last value if that is a picture."""
    *body, last = ast.parse('pass' if source == PICTURES else source).body
    printed, value = io.StringIO(), None
    with redirect_stdout(printed):
        if isinstance(last, ast.Expr):
            exec(compile(ast.Module(body, []), 'cell', 'exec'), names)
            value = eval(compile(ast.Expression(last.value), 'cell', 'eval'), names)
        else:
            exec(compile(ast.Module([*body, last], []), 'cell', 'exec'), names)
    outputs: list[dict[str, Any]] = []
    if printed.getvalue():
        lines = printed.getvalue().splitlines(keepends=True)
        outputs.append({'name': 'stdout', 'output_type': 'stream', 'text': lines})
    if isinstance(value, Figure):
        value.savefig(picture := io.BytesIO(), dpi=80)
        data = {'image/png': b64encode(picture.getvalue()).decode()}
        outputs.append({'data': data, 'metadata': {}, 'output_type': 'display_data'})
    return outputs


def _cell(kind: str, text: str) -> dict[str, Any]:
    outputs: dict[str, Any] = {'execution_count': None, 'outputs': []} if kind == 'code' else {}
    return {'cell_type': kind, 'metadata': {}, 'source': text.splitlines(keepends=True), **outputs}
