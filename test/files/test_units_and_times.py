# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Names with their units, counts of days, and times before the lines of instruments."""

from __future__ import annotations

from collections.abc import Callable
import json
from pathlib import Path

import numpy as np
import pytest

from tree_sway.core.tree.tree import Tree
from tree_sway.core.wind.limits import shorter_than
from tree_sway.errors import FormatError
from tree_sway.files.column_names import COLUMNS, is_name, name_and_unit, unit_in_name, UNITS
from tree_sway.files.scenes.inventory.cell_number import stems_number
from tree_sway.files.scenes.inventory.columns import InventoryColumns
from tree_sway.files.table_file import parse_table, TextTable
from tree_sway.files.time_stamps import times_of
from tree_sway.files.wind.wind_file import read_wind
from tree_sway.simulation.rig import simulate

DIAMETERS = ('stem_diameter', 'stemDiameter', 'trunk_diameter', 'trunk diameter', 'stem_diam')


@pytest.mark.parametrize('quantity', [each for each in COLUMNS if COLUMNS[each]['unit']])
def test_every_name_of_a_list_is_found_without_an_unknown_unit(quantity: str) -> None:
    for name in COLUMNS[quantity]['names']:
        table = parse_table([f'"{name}"\tother', '1\t2'], 'names.csv')
        found = table.find(quantity)
        assert found is not None, name
        assert found.index == 0, name


@pytest.mark.parametrize('name', DIAMETERS)
def test_a_name_is_not_cut_into_a_name_and_meters(name: str) -> None:
    table = parse_table([f'{name},x', '25,0'], 'trees.csv')
    assert table.unit_of(0, 'diameter') == ''
    table = parse_table([f'{name}_cm,x', '25,0'], 'trees.csv')
    assert table.unit_of(0, 'diameter') == 'cm'


@pytest.mark.parametrize('quantity', [each for each in COLUMNS if COLUMNS[each]['unit']])
def test_every_name_has_the_unit_behind_it(quantity: str) -> None:
    kind = COLUMNS[quantity]['unit']
    wrong = list[str]()
    for name in COLUMNS[quantity]['names']:
        if '(' in name or TextTable((name,), (), (), str.split, '').unit_of(0, quantity):
            continue
        for unit in (each for each in UNITS[kind] if each.isascii() and each.isalpha()):
            for column in (f'{name}_{unit}', f'{name} {unit}'):
                found = TextTable((column,), (), (), str.split, '').find(quantity)
                if not is_name(column, quantity) and (
                    found is None or found.factor != UNITS[kind][unit]
                ):
                    wrong.append(column)
    assert not wrong


@pytest.mark.parametrize(
    ('column', 'quantity', 'unit'),
    [
        ('windSpdKmh', 'wind_speed', 'kmh'), ('gustMph', 'gust', 'mph'),
        ('dbhInch', 'diameter', 'inch'), ('dbhCm', 'diameter', 'cm'), ('htFt', 'height', 'ft'),
        ('stem_diam_m', 'diameter', 'm'),
    ],
)  # fmt: skip
def test_a_unit_counts_in_camel_case(column: str, quantity: str, unit: str) -> None:
    assert TextTable((column,), (), (), str.split, '').unit_of(0, quantity) == unit


def test_a_bracket_of_a_name_is_no_unit() -> None:
    assert is_name('avg wind speed (10min)', 'wind_speed')
    assert unit_in_name('stem_diameter', 'diameter') == ''


@pytest.mark.parametrize('first', [46174.5, 740000.5, 2461000.25, 60600.5])
def test_days_are_counted_as_days(first: float) -> None:
    times = times_of([f'{first + i / 144:.6f}' for i in range(12)])
    assert times.seconds[-1] == pytest.approx(6600.0, abs=0.2)
    assert times.note
    assert times.epoch is not None
    assert 1e9 < times.epoch < 3e9


def test_other_readings_of_a_count_of_days_are_said() -> None:
    note = times_of(['46174.5', '46174.506944']).note
    assert "Excel's days since 1900, from 2026-06-01" in note
    assert "Excel's since 1904 from 2030-06-02" in note
    assert 'modified Julian days from 1985-04-19' in note
    assert 'from 2024-10-17' in times_of(['60600.5', '60600.506944']).note


@pytest.mark.parametrize('step', [0.0, 0.001, 1.0])
def test_days_that_may_be_seconds_are_said(step: float) -> None:
    count = 1 if step == 0.0 else 5
    times = times_of([f'{46174 + i * step:.3f}' for i in range(count)])
    assert times.epoch is None
    assert 'seconds, not as' in times.note


@pytest.mark.parametrize(
    ('header', 'is_said'), [('time', True), ('time [h]', False), ('seconds', False)]
)
def test_whole_steps_without_a_unit_are_said(tmp_path: Path, header: str, is_said: bool) -> None:
    path = tmp_path / 'wind.csv'
    rows = ''.join(f'{float(i)},3.0,270.0\n' for i in range(9))
    path.write_text(f'{header},speed [m/s],direction [deg]\n{rows}')
    assert any('no unit of time' in note for note in read_wind(path).notes) == is_said


def test_a_range_with_a_slash_is_said() -> None:
    columns = InventoryColumns(parse_table(['dbh,x', '18/20,0', '20/18/15,0'], 'trees.csv'))
    assert columns.numbers(0, stems=True)[0][0] == 19.0
    assert columns.notes == [
        '1 cells of dbh have several stems: one of their section',
        '1 cells of dbh are ranges: their middles',
    ]


@pytest.mark.parametrize('kind', sorted(UNITS))
def test_every_name_has_the_unit_in_its_brackets(kind: str) -> None:
    wrong = list[str]()
    for quantity in (each for each in COLUMNS if COLUMNS[each]['unit'] == kind):
        for name in COLUMNS[quantity]['names']:
            for unit, factor in UNITS[kind].items():
                column = f'{name} [{unit}]'
                table = TextTable((column,), (), (), str.split, 'names.csv')
                known = name_and_unit(name, kind)[1]
                if ')' not in unit and not known and table.factor_of(0, quantity) != factor:
                    wrong.append(column)
    assert not wrong


def test_seconds_of_the_day_stay_seconds() -> None:
    times = times_of([f'{46174.5 + i * 0.05:.2f}' for i in range(12)])
    assert times.seconds[-1] - times.seconds[0] == pytest.approx(0.55)
    assert 'seconds' in times.note


@pytest.mark.parametrize('text', ['20/18/15', '20|18|15', '20+18+15', '20;18;15'])
def test_stems_with_any_separator(text: str) -> None:
    found = stems_number(text)
    assert found is not None
    assert found[0] == pytest.approx(949**0.5)
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


def test_a_wind_shorter_than_asked_for_is_said() -> None:
    assert '6.6 s of the 60 s' in shorter_than(6.6, 60.0)
    assert not shorter_than(299.95, 300.0)
    assert not shorter_than(6.6, None)


def test_a_simulation_longer_than_its_wind_says_so(stem: Callable[..., Tree]) -> None:
    wind = np.zeros((30, 3))
    assert any('0.5 s of the 60 s' in each for each in simulate(stem(), wind, seconds=60.0).notes)
    assert not any('asked for' in each for each in simulate(stem(), wind, seconds=0.5).notes)


def test_a_quote_that_is_open_to_the_end_leaves_no_rows():
    lines = ['"time,u,v', '0,1,2"']
    with pytest.raises(FormatError, match='a quote is open from the header to the end'):
        parse_table(lines, 'a.csv')


HOURS = '2024-07-15 00:00,3.1,220\n2024-07-15 01:00,3.2,220\n2024-07-15 02:00,3.3,220\n'
SPEEDS = 'wind speed (m/s),wind dir (deg)\n'


@pytest.mark.parametrize(
    ('above', 'clock', 'ahead'),
    [
        ('', 'Timestamp (UTC-05:00)', -5.0),
        ('', '"Date Time, GMT+05:30"', 5.5),
        ('', 'time (Europe/Berlin)', 2.0),
        ('', 'Date-Time (EDT)', -4.0),
        ('', 'Timestamp (UTC)', 0.0),
        ('', 'time', 0.0),
        ('Station: West\nTime zone: UTC+2\n', 'time', 2.0),
        ('Station: West\nTimezone: CEST\n', 'time', 2.0),
        (
            'utc_offset_seconds,timezone\n7200,Africa/Cairo\n\n',
            'time',
            3.0,
        ),
        ('utc_offset_seconds: -12600\n', 'time', -3.5),
        ('Utc offset: +0930\n', 'time', 9.5),
        ('Time zone: 47\n', 'time', 0.0),
        ('POSIX name: Etc/GMT+5\n', 'time', 0.0),
        ('Time zone of the logger: see note 3\n', 'time', 0.0),
        ('All times in local time zone, 10-min means\n', 'time', 0.0),
        ('Local time zone; 5 minute averages\n', 'time', 0.0),
        ('Created: 2024-06-01T12:00 GMT+0200\n', 'time', 0.0),
        ('Region: Asia/Pacific\nTime zone: 8\n', 'time', 8.0),
        ('Time zone: 10.5\n', 'time', 10.5),
        ('Time zone: 5.75 h\n', 'time', 5.75),
        ('Time zone: ACDT\n', 'time', 10.5),
        ('Time zone,-3\n', 'time', -3.0),
        ('Time zone: Europe/Berlin\n', 'Timestamp (UTC)', 0.0),
        ('Time zone: Europe/Berlin\n', 'time_utc', 0.0),
        ('Time zone offset (hours): 2\n', 'time', 2.0),
    ],
)
def test_a_zone_that_a_table_tells_counts(
    tmp_path: Path, above: str, clock: str, ahead: float
) -> None:
    path = tmp_path / 'wind.csv'
    path.write_text(f'{above}{clock},{SPEEDS}{HOURS}', encoding='utf-8')
    record = read_wind(path, turbulence=False)
    assert record.epoch == np.datetime64('2024-07-15').astype('datetime64[s]').astype(int) - (
        3600.0 * ahead
    )
    assert any('on the clock of' in note for note in record.notes) == (ahead != 0.0)


@pytest.mark.parametrize(
    ('zone', 'ahead'),
    [('+02:00', 2), ('7200', 2), ('Europe/Berlin', 2), ('CEST', 2), ('2', 2), ('UTC', 0), ('', 0)],
)
def test_a_column_of_zones_counts(tmp_path: Path, zone: str, ahead: int) -> None:
    rows = ''.join(f'2024-07-15 0{n}:00,{zone},3.{n},220\n' for n in range(3))
    path = tmp_path / 'wind.csv'
    path.write_text(f'time,timezone,{SPEEDS}{rows}', encoding='utf-8')
    record = read_wind(path, turbulence=False)
    assert record.epoch == 1721001600.0 - 3600.0 * ahead


@pytest.mark.parametrize('own', ['Z', '+00:00'])
def test_times_with_a_zone_keep_it(tmp_path: Path, own: str) -> None:
    hours = [f'2024-07-15T0{n}:00:00{own}' for n in range(3)]
    told = {'utc_offset_seconds': 7200, 'timezone': 'Europe/Berlin'}
    speeds = {'wind_speed': [3.1] * 3, 'wind_direction': [220] * 3}
    path = tmp_path / 'wind.json'
    for times in (hours, [1721001600 + 3600 * n for n in range(3)]):
        path.write_text(json.dumps(told | {'hourly': {'time': times} | speeds}), encoding='utf-8')
        assert read_wind(path, turbulence=False).epoch == 1721001600.0
    local = [each.removesuffix(own) for each in hours]
    path.write_text(json.dumps(told | {'hourly': {'time': local} | speeds}), encoding='utf-8')
    assert read_wind(path, turbulence=False).epoch == 1721001600.0 - 7200.0


@pytest.mark.parametrize('zone', ['Europe/Atlantis', 'America/Argentina', 'Asia/mast2'])
def test_a_zone_that_is_not_known_is_said(tmp_path: Path, zone: str) -> None:
    path = tmp_path / 'wind.csv'
    for text in (f'time ({zone}),', f'of /data/{zone}.csv\ntime,'):
        path.write_text(f'{text}{SPEEDS}{HOURS}', encoding='utf-8')
        record = read_wind(path, turbulence=False)
        assert record.epoch == 1721001600.0
        assert any(f'zone {zone} is not known here' in note for note in record.notes)


def test_times_of_several_zones_are_left(tmp_path: Path) -> None:
    path = tmp_path / 'wind.csv'
    zones = ('CEST', 'CEST', 'CET')
    rows = ''.join(f'2024-10-27 0{n}:00,{zone},3,220\n' for n, zone in enumerate(zones))
    path.write_text(f'time,timezone,{SPEEDS}{rows}', encoding='utf-8')
    record = read_wind(path, turbulence=False)
    assert record.epoch == 1729987200.0
    assert any('is not known here; times are left' in note for note in record.notes)


@pytest.mark.parametrize('system', ['UTM32', 'EPSG:25832', 'Gauß-Krüger, Zone 3', 'm'])
def test_the_system_of_a_map_is_no_unit(system: str) -> None:
    columns = [f'{name} ({system})' for name in ('Rechtswert', 'Hochwert')]
    table = TextTable(tuple(columns), [2], [('390000', '5820000')], tuple, 'trees.csv')
    for quantity, index in (('x', 0), ('y', 1)):
        found = table.find(quantity)
        assert found is not None
        assert (found.index, found.factor) == (index, 1.0)
