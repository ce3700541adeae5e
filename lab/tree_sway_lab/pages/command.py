# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
``tree-sway lab docs``: write the tables and drawings of the pages from the code.

These are the tables of topics, parameters and species, the drawings of the rooms and of measured
against computed, and the examples as notebooks.

A table is between two comments, ``<!-- table: NAME -->`` and ``<!-- end -->``; what is between
them is replaced.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
import csv
from functools import partial
from pathlib import Path
import re

from tree_sway.commands import own_commands
from tree_sway.core.model import MEANINGS, TYPES
from tree_sway.core.species import species_keys, species_named
from tree_sway.errors import FormatError
from tree_sway.files import write_text_whole
from tree_sway.files.trees import FITTED, TREE_FORMATS
from tree_sway.parameters import Table, Value
from tree_sway_lab.chart.fidelity import MODELS
from tree_sway_lab.commands import COMMANDS as LAB_COMMANDS
from tree_sway_lab.pages.notebooks import notebook, with_outputs
from tree_sway_lab.pages.published_drawing import published_drawing
from tree_sway_lab.pages.rooms import rooms_drawing
from tree_sway_ros.parameters import NODE_PARAMETERS
from tree_sway_ros.process import TOPICS

PAGES = ('README.md', 'doc/models.md', 'doc/reference.md', 'doc/sway_model.md', 'doc/trees.md')
"""Pages with tables."""

FIGURES = 'doc/pictures/fidelity.csv'
"""What ``tree-sway lab chart fidelity`` measured."""

EXAMPLES = ('critical_wind_speed', 'response_spectra', 'sheltered_and_open')
"""Scripts that are notebooks as well."""

DRAWINGS: dict[str, Callable[[], str]] = {
    'doc/pictures/rooms.svg': rooms_drawing,
    'doc/pictures/published.svg': published_drawing,
    **{
        f'examples/{name}.ipynb': partial(notebook, Path('examples', f'{name}.py'))
        for name in EXAMPLES
    },
}
"""Files made whole: drawings of the source and of figures, the notebooks of the examples."""

_TABLE = re.compile(r'(<!-- table: (?P<name>\S+) -->\n).*?(<!-- end -->)', re.DOTALL)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument(
        'files',
        nargs='*',
        default=(*PAGES, *DRAWINGS),
        help=f'files with tables, or drawings ({", ".join((*PAGES, *DRAWINGS))})',
    )
    parser.add_argument(
        '--check', action='store_true', help='change nothing; exit 2 if not up to date'
    )
    parser.add_argument(
        '--run', action='store_true', help='run notebooks, and save what they print and draw'
    )


def run(arguments: argparse.Namespace) -> int:
    """Bring tables and drawings up to date, or check that they are."""
    for file in arguments.files:
        path = Path(file)
        text = path.read_text(encoding='utf-8') if path.is_file() or file not in DRAWINGS else ''
        fresh = DRAWINGS[file]() if file in DRAWINGS else with_tables(text, where=str(path))
        if arguments.run and path.suffix == '.ipynb':
            fresh = with_outputs(fresh)
        if fresh == text:
            print(f'{path}: up to date')
            continue
        if arguments.check:
            raise FormatError('not up to date', where=str(path), cure='run tree-sway lab docs')
        write_text_whole(path, fresh)
        print(f'{path}: written')
    return 0


def with_tables(text: str, where: str = 'text') -> str:
    """
    Replace the tables in a text by those of the code.

    Parameters
    ----------
    text
        Markdown with tables between marks.
    where
        Its name, for the error.

    Returns
    -------
    str
        The same text with fresh tables.

    Raises
    ------
    FormatError
        If a mark names a table that does not exist.

    """
    tables = markdown_tables()

    def fill(match: re.Match[str]) -> str:
        name = match['name']
        if name not in tables:
            cure = f'name one of: {", ".join(tables)}'
            raise FormatError(f"no table is called '{name}'", where=where, cure=cure)
        return f'{match[1]}{tables[name]}{match[3]}'

    return _TABLE.sub(fill, text)


def markdown_tables() -> dict[str, str]:
    """Every table by its name, as ``topics``; of the parameters of a node by the node's name."""
    tables = {
        'commands': commands_table(),
        'topics': topics_table(),
        'species': species_table(),
        'tree_formats': formats_table(),
        'fidelity': fidelity_table(),
        'fidelity_range': fidelity_range(),
        'sway_model': model_table(),
    }
    for node, table in NODE_PARAMETERS.items():
        tables[node] = parameters_table(table)
    return tables


def model_table() -> str:
    """Every array of a prepared model, group by group."""
    rows = ['| array | shape | unit | meaning |', '|---|---|---|---|']
    group = ''
    for name, meaning in MEANINGS.items():
        if meaning.group != group:
            group = meaning.group
            rows.append(f'| **{group}** | | | |')
        kind = {'int64': ' int', 'float32': ' float32'}.get(TYPES[name].__name__, '')
        shape = ', '.join(map(str, meaning.shape)) + (',' if len(meaning.shape) == 1 else '')
        rows.append(f'| `{name}` | ({shape}){kind} | {meaning.unit} | {meaning.text} |')
    return '\n'.join(rows) + '\n'


def commands_table() -> str:
    """Say what each command does, with its example; those of the laboratory come last."""
    lines = ['| command | what it does | example |', '|---|---|---|']
    tables = ('', own_commands()[0]), ('lab ', LAB_COMMANDS)
    lines += [
        f'| `{group}{name}` | {c.summary} | `tree-sway {group}{c.example}` |'
        for group, table in tables
        for name, c in table.items()
    ]
    return '\n'.join(lines) + '\n'


def topics_table() -> str:
    """Type, quality of service and content of each topic."""
    lines = ['| topic | type | QoS | content |', '|---|---|---|---|']
    for topic in TOPICS:
        reliability = 'reliable' if topic.reliable else 'best effort'
        service = f'{reliability}{", latched" if topic.latched else ""}, last {topic.depth}'
        cells = (f'`{topic.name}`', f'`{topic.type_name}`', service, topic.description)
        lines.append(f'| {" | ".join(cells)} |')
    return '\n'.join(lines) + '\n'


def parameters_table(table: Table) -> str:
    """Every parameter of a node with its default, unit, range and description."""
    lines = ['| parameter | default | unit | range | live | description |']
    lines.append('|---|---|---|---|---|---|')
    for p in table:
        limits = p.range_text.replace('|', '\\|')
        note = f' ({p.source})' if p.source else ''
        live = 'yes' if p.live else ''
        cells = (f'`{p.name}`', f'`{_text(p.default)}`', p.unit, limits, live)
        lines.append(f'| {" | ".join(cells)} | {p.description}{note} |')
    return '\n'.join(lines) + '\n'


def _text(value: Value) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, tuple):
        return '[' + ', '.join(f'{number:g}' for number in value) + ']'
    return '""' if value == '' else str(value)


def formats_table() -> str:
    """Lay out the formats of tree files, and whether they are fits of scans."""
    lines = ['| format | files | what it is |', '|---|---|---|']
    for each in TREE_FORMATS:
        kind = 'a fit to a scan' if each.defaults == FITTED else 'a description'
        lines.append(f'| {each.name} | {", ".join(each.suffixes)} | {kind} |')
    return '\n'.join(lines) + '\n'


def _fidelity() -> list[dict[str, str]]:
    """Rows of the chart's figures; none where the repository is not there."""
    path = Path(FIGURES)
    if not path.is_file():
        return []
    with path.open(encoding='utf-8', newline='') as file:
        return list(csv.DictReader(file))


def fidelity_table() -> str:
    """Error, roughness and time per frame of every model and engine on the trees of the chart."""
    rows = _fidelity()
    trees = list(dict.fromkeys(row['tree'] for row in rows))
    lines = [
        f'| model | {" | ".join(f"{tree}: error | roughness | us" for tree in trees)} |',
        f'|---|{"---|---|---|" * len(trees)}',
    ]
    for model in dict.fromkeys(row['model'] for row in rows):
        here = {row['tree']: row for row in rows if row['model'] == model}
        cells = (
            f'{float(here[tree]["error"]):.2g} | {float(here[tree]["roughness"]):.2g} | '
            f'{float(here[tree]["nanoseconds"]) / 1e3:.3g}'
            if tree in here
            else '- | - | -'
            for tree in trees
        )
        lines.append(f'| `{model}` | {" | ".join(cells)} |')
    return '\n'.join(lines) + '\n'


def fidelity_range() -> str:
    """One sentence on trees, wind and cost of the chart, for the line below it."""
    rows = _fidelity()
    costs = [float(row['nanoseconds']) / 1e3 for row in rows if row['model'] in MODELS] or [0.0]
    trees = ', '.join(dict.fromkeys(row['tree'] for row in rows))
    return (
        f'Trees: {trees}; {rows[0]["wind"] if rows else "no wind"}; our models take '
        f'{min(costs):.0f} to {max(costs):.0f} us of CPU time per frame, solving and placing.\n'
    )


def species_table() -> str:
    """Wood, damping, drag and leaves of every species."""
    lines = [
        '| key | species | E [GPa] | density [kg/m^3] | damping bare, in leaf | twigs [mm] | '
        'drag in leaf | leaves [m^2/m^2] | [kg/m^2] |',
        '|---|---|---|---|---|---|---|---|---|',
    ]
    for key in species_keys():
        wood, leaf = species_named(key), species_named(key).leaves
        mark = ' (an estimate)' if wood.is_estimate else ''
        lines.append(
            f'| `{key}` | {wood.title}{mark} | {wood.modulus / 1e9:.3g} | {wood.density:g} '
            f'| {wood.damping_bare:g}, {wood.damping_in_leaf:g} | {1e3 * wood.twig_diameter:g} '
            f'| {wood.drag_coefficient:g} U^-{wood.drag_exponent:g} '
            f'| {leaf.area_per_section:g}{", evergreen" if leaf.is_evergreen else ""} | '
            f'{leaf.fresh_mass:g} |'
        )
    return '\n'.join(lines) + '\n'
