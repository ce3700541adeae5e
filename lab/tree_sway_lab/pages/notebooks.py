# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Notebooks of the example scripts, so that each is written once and opens either way."""

from __future__ import annotations

import ast
import json
from pathlib import Path


def notebook(script: Path) -> str:
    """
    Turn an example script into a notebook.

    Its docstring becomes the heading and the text above, every function a cell with the constants
    before it, and the call of ``main`` the last cell.

    Parameters
    ----------
    script
        Python that ends by calling its function ``main``, which needs no arguments.

    Returns
    -------
    str
        A notebook of format 4.5 without outputs.

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
    cells.append(_cell('code', 'main()'))
    kernel = {'display_name': 'Python 3', 'language': 'python', 'name': 'python3'}
    whole = {
        'cells': [{'id': f'cell-{number}', **cell} for number, cell in enumerate(cells)],
        'metadata': {'kernelspec': kernel},
        'nbformat': 4,
        'nbformat_minor': 5,
    }
    return json.dumps(whole, indent=1, ensure_ascii=False) + '\n'


def _cell(kind: str, text: str) -> dict[str, object]:
    outputs: dict[str, object] = {'execution_count': None, 'outputs': []} if kind == 'code' else {}
    return {'cell_type': kind, 'metadata': {}, 'source': text.splitlines(keepends=True), **outputs}
