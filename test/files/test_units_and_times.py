# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Names with their units, counts of days, and times before the lines of instruments."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tree_sway.files.column_names import COLUMNS, is_name, trailing_unit
from tree_sway.files.scenes.inventory.cell_number import stems_number
from tree_sway.files.table_file import parse_table
from tree_sway.files.time_stamps import times_of
from tree_sway.files.wind.wind_file import read_wind

DIAMETERS = ('stem_diameter', 'stemDiameter', 'trunk_diameter', 'trunk diameter', 'stem_diam')


@pytest.mark.parametrize('quantity', [each for each in COLUMNS if COLUMNS[each]['unit']])
def test_every_name_of_a_list_is_found_without_an_unknown_unit(quantity: str) -> None:
    for name in COLUMNS[quantity]['names']:
        table = parse_table([f'"{name}"\tother', '1\t2'], 'names.csv')
        found = table.find(quantity)
        assert found is not None and found.index == 0, name


@pytest.mark.parametrize('name', DIAMETERS)
def test_a_name_is_not_cut_into_a_name_and_meters(name: str) -> None:
    table = parse_table([f'{name},x', '25,0'], 'trees.csv')
    assert table.unit_of(0, 'diameter') == ''
    table = parse_table([f'{name}_cm,x', '25,0'], 'trees.csv')
    assert table.unit_of(0, 'diameter') == 'cm'


def test_a_bracket_of_a_name_is_no_unit() -> None:
    assert is_name('avg wind speed (10min)', 'wind_speed')
    assert trailing_unit('stem_diameter', 'stem dia', 'length') == ''


@pytest.mark.parametrize('first', [46174.5, 740000.5, 2461000.25, 60600.5])
def test_days_are_counted_as_days(first: float) -> None:
    times = times_of([f'{first + i / 144:.6f}' for i in range(12)])
    assert times.seconds[-1] == pytest.approx(6600.0, abs=0.2)
    assert times.note and times.epoch is not None and 1e9 < times.epoch < 3e9


def test_seconds_of_the_day_stay_seconds() -> None:
    times = times_of([f'{46174.5 + i * 0.05:.2f}' for i in range(12)])
    assert times.seconds[-1] - times.seconds[0] == pytest.approx(0.55)
    assert 'seconds' in times.note


@pytest.mark.parametrize('text', ['20/18/15', '20|18|15', '20+18+15', '20;18;15'])
def test_stems_with_any_separator(text: str) -> None:
    found = stems_number(text)
    assert found is not None and found[0] == pytest.approx(949**0.5)
    assert stems_number('18/20') == (19.0, '')


def test_times_before_sentences_are_used(tmp_path: Path) -> None:
    path = tmp_path / 'wind.nmea'
    line = 'AIS,$WIMWV,240.0,T,4.6,M,A*22'
    path.write_text(''.join(f'{1780000000000 + 500 * i},{line}\n' for i in range(9)))
    record = read_wind(path)
    assert record.duration == pytest.approx(4.0)
    assert record.epoch == pytest.approx(1780000000.0)


def test_windguru_is_in_knots(tmp_path: Path) -> None:
    path = tmp_path / 'windguru.json'
    columns = {
        'unixtime': [1780000000 + i for i in range(5)], 'wind_avg': [10.0] * 5,
        'wind_max': [12.0] * 5, 'wind_direction': [270.0] * 5,
    }  # fmt: skip
    path.write_text(json.dumps(columns))
    assert any('kn' in note for note in read_wind(path).notes)
