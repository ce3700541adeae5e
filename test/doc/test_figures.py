# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""No sentence of the pages names a figure or a file format that the program does not have."""

from __future__ import annotations

import argparse
from pathlib import Path
import re
import runpy
import shlex
from types import SimpleNamespace

import pytest

from tree_sway.cache.model_cache import MOST
from tree_sway.commands import cli
from tree_sway.core.drag import load_spreads
from tree_sway.core.settings import USUAL
from tree_sway.core.species.species import ROOT_MOMENT, species_named
from tree_sway.files.scenes import classes as kind_classes
from tree_sway.files.trees.tree_file import TREE_FORMATS
from tree_sway.files.wind.wind_file import WIND_FORMATS
from tree_sway.page import page_client, server
from tree_sway.simulation import strength_band
from tree_sway.simulation.wind.about_means import LEAST_INTERVAL
from tree_sway.stream import check_description, client, playout, protocol

pages = SimpleNamespace(**runpy.run_path(str(Path(__file__).with_name('test_pages.py'))))
ROOT: Path = pages.ROOT
MIB = 2**20
FIGURES = {
    'README.md': {
        r'the number of coordinates, (\d+) by default': [USUAL],
    },
    'doc/models.md': {r'`(\d+)` \(default\)': [USUAL]},
    'doc/tree_as_a_file.md': {r'`--model 20`: 20 coordinates, not (\d+)': [USUAL]},
    'doc/tutorials/study.md': {r'one model for all trees, (\d+) coordinates': [USUAL]},
    'doc/tutorials/scan_to_numbers.md': {
        r'band that holds (\d+) % of trees': [round(100 * load_spreads.SHARE_WITHIN)],
        r'\| wood \| ([\d.]+), and up to (\d+) % off for knots': [
            strength_band.WOOD, round(100 * strength_band.KNOTS),
        ],
        r'\| roots \| ([\d.]+) of trees of one species and size, ([\d.]+) of species': [
            strength_band.ROOTS_OF_A_SPECIES, strength_band.ROOTS_OF_SPECIES,
        ],
        r'\| drag of the crown \| ([\d.]+) ': [load_spreads.DRAG],
        r'\| wind at the crown \| ([\d.]+) of the load': [load_spreads.WIND],
        r'\| leaves, in leaf \| ([\d.]+) ': [load_spreads.LEAVES],
        r'(\d+) N m of root moment': [ROOT_MOMENT],
    },
    'doc/reference.md': {r'Rows (\d+) s and more apart are means': [LEAST_INTERVAL]},
    'doc/trees.md': {
        r'more than ([\d.]+) times as high': [round(kind_classes._HEIGHTS**0.5, 1)],
        r'height to diameter differs by more than (\d+) %': [
            round(100 * (kind_classes._SLENDERNESSES**0.5 - 1)),
        ],
        r'\| `oak` \| oak \| ([\d.]+) \| (\d+) ': [
            species_named('oak').modulus / 1e9, species_named('oak').density,
        ],
    },
    'doc/faq.md': {r'prepared models of the last (\d+) trees': [MOST]},
    'doc/streaming.md': {
        r'Up to (\d+) MiB with a header of (\d+) MiB': [
            protocol.LARGEST_DESCRIPTION / MIB, protocol.LARGEST_HEADER / MIB,
        ],
        r'([\d,]+) segments in all kinds, (\d+) million in all trees, ([\d,]+) coordinates': [
            check_description.MOST_SEGMENTS, check_description.MOST_POSES / 1e6,
            check_description.MOST_COORDINATES,
        ],
        r'frames per second that it takes, ([\d.]+) to (\d+)': [
            page_client.SLOWEST, page_client.FASTEST,
        ],
        r'allow (\d+) kB under way, (\d+) to (\d+) frames': [
            client._ON_THE_WAY / 1e3, client._LEAST_CREDIT, client._MOST_CREDIT,
        ],
        r'every (\d+) s up to (\d+) coordinates': [
            page_client.STATE_PERIOD, page_client.MOST_IN_STATE,
        ],
        r'made again after ([\d.]+) s, then 1, 2, up to (\d+)': [
            client._SHORTEST_WAIT, client._LONGEST_WAIT,
        ],
        r'blends over ([\d.]+) s after a gap': [playout._BLEND],
        r'in units of ([\d.]+) m/s': [protocol.WIND_UNIT],
        r'Messages above (\d+) kB': [server.LARGEST_MESSAGE / 1024],
        r'not reading for (\d+) s': [page_client._SEND_TIMEOUT],
        r'A frame of the wind alone has M = 0 and is (\d+) bytes': [protocol.FRAME_SIZE],
    },
}  # fmt: skip
ROWS = [
    pytest.param(page, pattern, figures, id=f'{page}: {pattern}')
    for page, rows in FIGURES.items()
    for pattern, figures in rows.items()
]


@pytest.mark.parametrize(('page', 'pattern', 'figures'), ROWS)
def test_a_figure_is_that_of_the_program(page: str, pattern: str, figures: list[float]) -> None:
    text = ' '.join((ROOT / page).read_text(encoding='utf-8').split())
    found = re.search(pattern, text)
    assert found, f'{page} has no sentence of it any more: {pattern}'
    assert [float(each.replace(',', '')) for each in found.groups()] == list(map(float, figures))


READ = {each.name for each in (*TREE_FORMATS, *WIND_FORMATS)}
NAMED = {
    'TreeQSM': 'treeqsm-text', 'SimpleForest': 'simpleforest', 'aRchi': 'archi', 'MTG': 'mtg',
    'SWC': 'swc', 'RayCloudTools': 'treefile', 'PyTLidar': 'treeqsm-text', 'TOA5': 'toa5',
    'NMEA': 'nmea', 'METAR': 'metar', 'rosbag2': 'bag', 'Gill': 'sonic',
    'netCDF': 'netcdf', 'PLY': 'ply', 'rTwig': 'rtwig', 'treegraph': 'treegraph',
}  # fmt: skip
"""Formats that pages name, and the program's name of each."""
NOT_HERE = re.compile(
    r'\b(FBX|LAS|LAZ|STL|DXF|IFC|HDF5|GRIB2?|Alembic|KML|GPX|'
    r'Collada|URDF|AVI|WebM|E57|VTK|Feather|ORC|shapefile)\b',
    re.IGNORECASE,
)
"""Formats of trees, winds, scenes, tables and films that the program neither reads nor writes."""


@pytest.mark.parametrize('page', pages.PAGES, ids=pages.name)
def test_no_sentence_names_a_format_that_is_not_there(page: Path) -> None:
    text = page.read_text(encoding='utf-8')
    assert not NOT_HERE.findall(text)
    named = {key for key in NAMED if re.search(rf'\b{key}\b', text)}
    assert {NAMED[key] for key in named} <= READ


def test_every_format_that_is_read_is_named() -> None:
    text = (ROOT / 'doc' / 'reference.md').read_text(encoding='utf-8')
    assert not {each.name for each in TREE_FORMATS if f'| {each.name} |' not in text}
    names = {key.lower() for key in NAMED if key in text}
    assert {NAMED[key] for key in NAMED if key.lower() in names} >= {
        each.name for each in WIND_FORMATS if each.name != 'csv'
    }


def written() -> list[tuple[str, str, str]]:
    """Page, command and suffix of every file that a command line of a page writes."""
    lines = pages.commands()
    for page in pages.PAGES:
        spans = pages.SPAN.findall(page.read_text(encoding='utf-8'))
        lines += [(pages.name(page), span) for span in spans]
    found = []
    for page, line in lines:
        words = shlex.split(line)
        for option in {'-o', '--output'} & set(words):
            after = words[words.index(option) + 1 :]
            if after and '.' in after[0]:
                found.append((page, words[0], Path(after[0]).suffix))
    return sorted(set(found))


@pytest.mark.parametrize(('page', 'command', 'suffix'), written())
def test_a_file_that_a_page_writes_is_of_a_format_of_the_command(
    page: str, command: str, suffix: str
) -> None:
    table, group = cli._table(command)
    assert not group, page
    parser = argparse.ArgumentParser()
    cli._module(table[command]).add_arguments(parser)
    (output,) = [each for each in parser._actions if '--output' in each.option_strings]
    assert suffix in re.findall(r'\.\w+', output.help or ''), f'{page}: {output.help}'
