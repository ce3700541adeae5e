# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A newcomer's changes as CONTRIBUTING has them: in one file, taken up by the tests there are."""

from __future__ import annotations

import os
from pathlib import Path
import re
import subprocess
import sys

import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / 'CONTRIBUTING.md').read_text(encoding='utf-8')


def blocks_of(heading: str) -> list[str]:
    """Blocks of Python or of rows under a heading of the page."""
    section = PAGE.split(f'## {heading}\n')[1].split('\n## ')[0]
    return re.findall(r'^```(?:py|csv)\n(.*?)^```$', section, re.MULTILINE | re.DOTALL)


def changed_copy(folder: Path, module: str, text: str) -> None:
    """Link package and tests into a folder, but for one module, which is written as given."""
    (folder / 'test').symlink_to(ROOT / 'test')
    (folder / 'pyproject.toml').symlink_to(ROOT / 'pyproject.toml')
    for source in sorted((ROOT / 'tree_sway').rglob('*')):
        target = folder / source.relative_to(ROOT)
        if source.is_dir():
            target.mkdir(parents=True, exist_ok=True)
        elif source.suffix in ('.py', '.json', '.yaml', '.csv'):
            target.parent.mkdir(parents=True, exist_ok=True)
            target.symlink_to(source)
    (folder / module).unlink()
    (folder / module).write_text(text, encoding='utf-8')


def test_a_new_species_is_one_row_of_one_file(tmp_path: Path) -> None:
    module = 'tree_sway/core/species/species.csv'
    text = (ROOT / module).read_text(encoding='utf-8')
    (row,) = blocks_of('A new species')
    changed_copy(tmp_path, module, re.sub('^ash,', f'{row}ash,', text, flags=re.M))
    environment = os.environ | {'PYTHONPATH': str(tmp_path)}
    known = "from tree_sway import species_named; print(species_named('mulberry').title)"
    words = ['-m', 'pytest', '-p', 'no:cacheprovider', '-p', 'no:xdist']
    tests = [*words, 'test/core/species/test_species.py', '-v']
    for arguments, wanted in ((['-c', known], 'mulberry'), (tests, '[mulberry]')):
        result = subprocess.run(
            [sys.executable, *arguments], cwd=tmp_path, env=environment,
            capture_output=True, text=True, timeout=300, check=False,
        )  # fmt: skip
        assert result.returncode == 0, result.stdout + result.stderr
        assert wanted in result.stdout


#: Changes of the table "To change X, edit Y": the module, what is there, what takes its place, a
#: program, and what it prints with the change alone.
CHANGES = {
    'species': (
        'tree_sway/core/species/species.csv',
        'ash,ash,broadleaf,no,9.5e9', 'ash,ash,broadleaf,no,8.5e9',
        "from tree_sway import species_named; print(species_named('ash').modulus)", '8500000000.0',
    ),
    'habit': (
        'tree_sway/growth/broadleaf_forms.csv', 'ash,0.17,', 'elm,0.17,',
        "from tree_sway.growth import forms; print('elm' in str(vars(forms)))", 'True',
    ),
    'turbulence': (
        'tree_sway/core/wind/turbulence.py',
        'REFERENCE_INTENSITY = 0.14', 'REFERENCE_INTENSITY = 0.16',
        'from tree_sway.core.wind.turbulence import REFERENCE_INTENSITY as i; print(i)',
        '0.16',
    ),
    'fault': (
        'tree_sway/simulation/wind/sensor_faults.py', '_SPIKE = 20.0', '_SPIKE = 30.0',
        'from tree_sway.simulation.wind.sensor_faults import SensorFaults;'
        "faults = SensorFaults('spike', every=1.0, duration=0.5);"
        'print(*(float(each.vector[0]) for each in faults.sent(1.0, 0, [0.0, 0.0, 0.0])))',
        '30.0',
    ),
    'flutter': (
        'tree_sway/core/leaves/flutter.py', 'LARGEST_ANGLE = 0.7', 'LARGEST_ANGLE = 0.5',
        'from tree_sway.core.leaves.flutter import flutter_amplitude;'
        'print(float(flutter_amplitude(90.0, 1.0)))',
        '0.5',
    ),
    'air': (
        'tree_sway/core/drag/drag_law.py', 'AIR_DENSITY = 1.225', 'AIR_DENSITY = 1.0',
        'from tree_sway.core.drag.drag_law import AIR_DENSITY; print(AIR_DENSITY)', '1.0',
    ),
    'unit': (
        'tree_sway/files/columns.json', '"mph": 0.44704,', '"mph": 0.44704, "yd/s": 0.9144,',
        "from tree_sway.files.table_file import UNITS; print(UNITS['speed']['yd/s'])",
        '0.9144',
    ),
    'maker': (
        'tree_sway/files/makers.csv', 'Netatmo,windstrength windangle,,,,km/h',
        'Netatmo,windstrength windangle,,,,kn',
        'from tree_sway.files.makers import maker_of; from tree_sway.files.table_file import *;'
        "print(maker_of(parse_table(['WindStrength,WindAngle', '1,2'], ''))['speed'])",
        'kn',
    ),
    'format': (
        'tree_sway/files/trees/formats/swc.py', "FileFormat('swc'", "FileFormat('neuron'",
        'from tree_sway.files.trees.tree_file import TREE_FORMATS;'
        "print('neuron' in [each.name for each in TREE_FORMATS])",
        'True',
    ),
    'instrument': (
        'tree_sway/files/wind/instruments.csv', 'Young 81000,', 'R. M. Young 81000,',
        'from tree_sway.live.readers.instrument_lines import EXPECTS;'
        "print('R. M. Young 81000' in EXPECTS)",
        'True',
    ),
    'command': (
        'tree_sway/simulation/commands/commands.csv', 'info benjamina', 'info goldcrest',
        "from tree_sway.simulation.commands import COMMANDS; print(COMMANDS['info'].example)",
        'info goldcrest',
    ),
    'ending': (
        'tree_sway/commands/ending.py', 'LONGEST = 1.5', 'LONGEST = 2.5',
        'from tree_sway.commands.ending import Ending; print(Ending.LONGEST)', '2.5',
    ),
}  # fmt: skip


@pytest.mark.parametrize('change', CHANGES)
def test_it_is_where_the_page_says(tmp_path: Path, change: str) -> None:
    module, before, after, program, printed = CHANGES[change]
    table = PAGE.split('## To change X, edit Y\n')[1].split('\n## ')[0]
    assert f'`{module}`' in table or f'`{module.rpartition("/")[0]}/`' in table
    text = (ROOT / module).read_text(encoding='utf-8')
    assert text.count(before) == 1, before
    changed_copy(tmp_path, module, text.replace(before, after))
    environment = os.environ | {'PYTHONPATH': str(tmp_path)}
    result = subprocess.run(
        [sys.executable, '-c', program], cwd=tmp_path, env=environment,
        capture_output=True, text=True, timeout=60, check=True,
    )  # fmt: skip
    assert result.stdout.strip() == printed


def test_every_row_of_the_page_is_tried() -> None:
    table = PAGE.split('## To change X, edit Y\n')[1].split('\n## ')[0]
    assert len(re.findall(r'^\| (?!to change|---)', table, re.MULTILINE)) == len(CHANGES)
