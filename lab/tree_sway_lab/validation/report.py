# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A folder for each claim, ``proof/NAME``, and the page ``validation.md`` with what they come to.

A folder has how it was measured, the command that measures it again, every check with its limit,
and its further figures, as ``figures.csv`` where they are many. Each is measured and replaced on
its own, and the page is written again after each, so a run that ends early has written what it has
measured.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable
from concurrent.futures import ProcessPoolExecutor
import csv
from datetime import datetime, timezone
from importlib import import_module
from importlib.metadata import version
import io
import multiprocessing
import os
from pathlib import Path
import re
import subprocess
from typing import Any

from tree_sway.commands import bar
from tree_sway.errors import ParameterError
from tree_sway.files import write_text_whole
from tree_sway_lab.validation.section import CHECKS, Effort, HOLDS, MISSES, Section

SECTIONS = (
    'kinds', 'storms', 'models', 'estimates', 'table', 'steady_sway', 'gust', 'engine', 'scans',
    'cut_scans', 'still_air', 'leaves', 'slopes', 'crown_gusts', 'conifers', 'published',
    'held_out', 'forestgales', 'storm_losses', 'broadleaves', 'battery', 'paper',
)  # fmt: skip
"""Names of the sections, each a module of ``sections``."""

PAGE = 'validation.md'
LONGEST = 40
"""Rows of a table from which on it is a file of its own."""

_HEAD = Path(__file__).with_name('first_screen.md').read_text(encoding='utf-8')
_TABLE = re.compile(r'(?:^\|.*\n)+', re.MULTILINE)


def write_validation(
    folder: str | Path,
    only: Iterable[str] = (),
    *,
    is_full: bool = False,
    data: Path | None = None,
) -> list[str]:
    """
    Measure claims, and write their folders and the page.

    Parameters
    ----------
    folder
        Where the page and the folder ``proof`` are, or are to be.
    only
        Names of `SECTIONS`; all if there are none.
    is_full, data
        As in `Effort`.

    Returns
    -------
    list of str
        Checks that miss their limit in these sections.

    Raises
    ------
    ParameterError
        If no section has a name that was given.

    """
    names = list(only) or list(SECTIONS)
    for name in names:
        if name not in SECTIONS:
            raise ParameterError(
                f"no section '{name}'", where='--only', cure=f'name one of: {", ".join(SECTIONS)}'
            )
    missed = []
    # One thread per process: they share the cores already.
    os.environ.setdefault('OPENBLAS_NUM_THREADS', '1')
    context = multiprocessing.get_context('spawn')
    with ProcessPoolExecutor(mp_context=context) as pool:

        def each(function: Callable[..., Any], items: Collection[Any]) -> list[Any]:
            running = [pool.submit(function, item) for item in items]
            return [one.result() for one in bar(running, name)]

        for name in names:
            section = measured(name, Effort(each, is_full, data))
            missed += [f'{name}: {check.what}' for check in section.checks if not check.holds]
            write_proof(Path(folder), name, section.markdown(), f'Measured on {_stamp()}.')
            print(f'{name}: {sum(c.holds for c in section.checks)} of {len(section.checks)} hold')
    return missed


def _stamp() -> str:
    """Return today's date and the commit, or the version where there is no repository."""
    today = datetime.now(tz=timezone.utc).date().isoformat()
    command = ['git', 'rev-parse', '--short', 'HEAD']
    where = Path(__file__).parent
    try:
        ran = subprocess.run(command, cwd=where, capture_output=True, text=True, check=True)
    except (OSError, subprocess.CalledProcessError):
        return f'{today}, version {version("tree_sway_lab")}'
    return f'{today}, commit {ran.stdout.strip()}'


def measured(name: str, effort: Effort) -> Section:
    """Measure a section."""
    found: Section = import_module(f'{__package__}.sections.{name}').measure(effort)
    return found


def write_proof(folder: Path, name: str, section: str, stamp: str) -> None:
    """Write the folder of a claim by the text of its section, and the page of all."""
    home = folder / 'proof' / name
    home.mkdir(parents=True, exist_ok=True)

    def table(found: re.Match[str]) -> str:
        head, _, *rows = found[0].splitlines()
        if len(rows) < LONGEST or head == CHECKS:
            return found[0]
        lines = [[cell.strip() for cell in row.strip('|').split('|')] for row in (head, *rows)]
        text = io.StringIO()
        csv.writer(text, lineterminator='\n').writerows(lines)
        write_text_whole(home / 'figures.csv', text.getvalue())
        return f'{len(rows)} rows of {", ".join(lines[0])}: [figures.csv](figures.csv).\n'

    title, _, text = section.partition('\n')
    command = f'`tree-sway lab validate --only {name} -o doc` measures it again.'
    parts = title.replace('##', '#'), '', command, _TABLE.sub(table, text).rstrip('\n'), '', stamp
    write_text_whole(home / 'README.md', '\n'.join((*parts, '')))
    write_text_whole(folder / PAGE, page_of(folder))


def page_of(folder: Path) -> str:
    """Return the page: the claims, and a row for every folder that is there."""
    lines = ['| claim | hold | miss | measured |', '|---|---|---|---|']
    for name in SECTIONS:
        path = folder / 'proof' / name / 'README.md'
        if not path.is_file():
            continue
        text = path.read_text(encoding='utf-8')
        title = text.partition('\n')[0].strip('# ')
        holds, misses = (text.count(f'| {mark} |') for mark in (HOLDS, MISSES))
        stamp = text.rstrip().rpartition('\n')[2].removeprefix('Measured on ').rstrip('.')
        link = f'[{title}](proof/{name}/README.md)'
        lines.append(f'| `{name}`: {link} | {holds} | {misses} | {stamp} |')
    return '\n'.join((_HEAD + '\n'.join(lines), ''))
