# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The page ``validation.md``: a section per subject, each measured and replaced on its own.

A section is between two comments, ``<!-- section: NAME -->`` and ``<!-- end -->``. The page is
written again after each, so a run that ends early has written what it has measured.

"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable
from concurrent.futures import ProcessPoolExecutor
from datetime import datetime, timezone
from importlib import import_module
from importlib.metadata import version
import multiprocessing
import os
from pathlib import Path
import re
import subprocess
from typing import Any

from tree_sway.commands import bar
from tree_sway.errors import ParameterError
from tree_sway.files import write_text_whole
from tree_sway_lab.validation.section import Effort, HOLDS, MISSES, Section

SECTIONS = (
    'kinds', 'storms', 'models', 'estimates', 'table', 'steady_sway', 'gust', 'engine', 'scans',
    'still_air', 'leaves', 'slopes', 'crown_gusts', 'conifers', 'published', 'held_out',
    'forestgales', 'broadleaves', 'battery', 'paper',
)  # fmt: skip
"""Names of the sections, each a module of ``sections``."""

PAGE = 'validation.md'

_HEAD = Path(__file__).with_name('first_screen.md').read_text(encoding='utf-8')
_SECTION = re.compile(r'<!-- section: (?P<name>\w+) -->\n(?P<text>.*?)<!-- end -->\n', re.DOTALL)


def write_validation(
    folder: str | Path,
    only: Iterable[str] = (),
    *,
    is_full: bool = False,
    data: Path | None = None,
) -> list[str]:
    """
    Measure sections and put them into the page.

    Parameters
    ----------
    folder
        Where the page is, or is to be.
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
    page, missed = Path(folder) / PAGE, []
    page.parent.mkdir(parents=True, exist_ok=True)
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
            text = page.read_text(encoding='utf-8') if page.is_file() else ''
            written = section.markdown() + f'\nMeasured on {_stamp()}.\n'
            write_text_whole(page, with_section(text, name, written))
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


def with_section(page: str, name: str, section: str) -> str:
    """Return the page with a section put in or replaced, in order, and with its summary."""
    texts = sections_of(page) | {name: section}
    ordered = [each for each in SECTIONS if each in texts]
    lines = ['| section | hold | miss |', '|---|---|---|']
    for each in ordered:
        counts = (texts[each].count(f'| {mark} |') for mark in (HOLDS, MISSES))
        lines.append(f'| {each} | ' + ' | '.join(map(str, counts)) + ' |')
    body = [f'<!-- section: {each} -->\n{texts[each]}<!-- end -->\n' for each in ordered]
    return '\n'.join((_HEAD + '\n'.join(lines) + '\n', *body))


def sections_of(page: str) -> dict[str, str]:
    """Return the text of each section of a page."""
    return {match['name']: match['text'] for match in _SECTION.finditer(page)}
