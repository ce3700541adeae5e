# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Every name of every list goes through the reader that uses it, in any form, with any unit."""

from __future__ import annotations

from collections import defaultdict
import json
from pathlib import Path
import re
from tempfile import TemporaryDirectory

from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import pytest

from tree_sway.core.species.species import species_like
from tree_sway.errors import FormatError
from tree_sway.files.column_names import COLUMNS, folded, MOTIONS, rank_of, unit_factor, UNITS
from tree_sway.files.motion.motion_file import read_motion
from tree_sway.files.row_times import PARTS
from tree_sway.files.scenes.inventory.read_inventory import inventory_of
from tree_sway.files.scenes.inventory.species_codes import FIA, ICP, name_of, names_of
from tree_sway.files.table_file import parse_table, TextTable
from tree_sway.files.wind.compass import degrees_of
from tree_sway.files.wind.wind_file import read_wind
from tree_sway.tables import table_beside

ROOT = Path(__file__).resolve().parents[2] / 'tree_sway' / 'files'
MAKERS = table_beside(str(ROOT / 'makers.py'), 'makers.csv')
WIND_MAKERS = [each for each in MAKERS if each['speed']]
MOTION_MAKERS = [each for each in MAKERS if each['acceleration'] or each['rate']]
WIND = (
    'time',
    'wind_x',
    'wind_y',
    'wind_z',
    'wind_speed',
    'wind_direction',
    'wind_to',
    'gust',
    'value',
)
INVENTORY = tuple(each for each in COLUMNS if each not in WIND and each not in MOTIONS)
BY_RULE = {
    'species': 'epithet', 'speciesname': 'epithet', 'art': 'epithet', 'espece': 'epithet',
    'specie': 'epithet',
}  # fmt: skip
"""Names of the whole name, which are those of the epithet where a column of the genus is."""

FORMS = (
    '{name} [{unit}]', '{name} ({unit})', '{name}({unit})', '{name}, {unit}', '{name} - {unit}',
    '{name}_{unit}', '{name} {unit}', '{name} in {unit}', '{unit} below',
)  # fmt: skip


def known_units(quantity: str) -> dict[str, float]:
    """Units of a quantity that may be written anywhere, and their factors."""
    return {
        unit: factor
        for unit, factor in UNITS.get(COLUMNS[quantity]['unit'], {}).items()
        if re.fullmatch(r'[a-z]+/?[a-z]+|m', unit) and unit not in ('in', 'gr')
    }


def own_unit(name: str, quantity: str) -> str:
    """Return the unit that a name has by itself."""
    return TextTable((name,), (), (), str.split, '').unit_of(0, quantity)


NAMED = [
    (quantity, name)
    for quantity in COLUMNS
    if COLUMNS[quantity]['unit'] in UNITS
    for name in COLUMNS[quantity]['names']
]


@settings(max_examples=1500)
@given(st.sampled_from(NAMED), st.sampled_from(FORMS), st.sampled_from(['', 'upper']), st.data())
def test_a_name_has_its_unit_in_any_form(
    named: tuple[str, str], form: str, case: str, data: st.DataObject
) -> None:
    quantity, name = named
    unit, factor = data.draw(st.sampled_from(sorted(known_units(quantity).items())))
    if own_unit(name, quantity) or '(' in name:
        return
    is_below = form.endswith('below')
    column = name if is_below else form.format(name=name, unit=unit)
    if folded(column) in map(folded, COLUMNS[quantity]['names']) and not is_below:
        return
    column = column.upper() if case else column
    units = (unit,) if is_below else ()
    found = TextTable((column,), (), (), str.split, '', units=units).find(quantity)
    assert found is not None, column
    assert found.factor == pytest.approx(factor), column


def wind_of(head: str, row: str) -> np.ndarray:
    """Mean wind of a table of four rows; ``{k}`` is their number."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / 'wind.csv'
        lines = [head, *(row.replace('{k}', str(k)) for k in range(1, 5))]
        path.write_text('\n'.join(lines) + '\n', encoding='utf-8')
        record = read_wind(path, format='csv', turbulence=False)
    assert len(record.time) == 4, head
    assert record.gust is None or record.gust[0] == pytest.approx(7.0), head
    return record.velocity.mean(axis=0)


@pytest.mark.parametrize('quantity', WIND[1:])
def test_every_name_of_the_wind_is_read(quantity: str) -> None:
    for name in COLUMNS[quantity]['names']:
        factor = unit_factor('speed', own_unit(name, quantity)) or 1.0
        value = f'{(7.0 if quantity == "gust" else 5.0) / factor!r}'
        quoted = f'"{name}"'
        if quantity.startswith('wind_') and quantity[-1] in 'xyz':
            heads = {'wind_x': 'wind_u', 'wind_y': 'wind_v', 'wind_z': 'wind_w'}
            others = [each for each in heads if each != quantity]
            head = ';'.join(['zeit', quoted, *(heads[each] for each in others)])
            expected = np.where(np.array(list(heads)) == quantity, 5.0, 0.0)
            found = wind_of(head, f'2026-03-01 0{{k}}:00;{value};0.0;0.0')
        else:
            columns = {'wind_speed': 'ff [m/s]', 'wind_direction': 'dd', 'gust': 'fx [m/s]'}
            columns[quantity] = quoted
            cells = {'wind_speed': '5.0', 'wind_direction': '270', 'gust': '7.0'}
            cells[quantity] = value if quantity != 'wind_direction' else '270'
            found = wind_of(
                ';'.join(['zeit', *columns.values()]),
                ';'.join(['2026-03-01 0{k}:00', *cells.values()]),
            )
            expected = np.array([5.0, 0.0, 0.0])
        np.testing.assert_allclose(found, expected, atol=1e-6, err_msg=name)


def test_every_name_of_a_time_is_read() -> None:
    for name in COLUMNS['time']['names']:
        table = parse_table([f'"{name}";x', '2026-03-01 01:00;1'], 'a.csv')
        found = table.find('time')
        assert found is not None, name
        wind = wind_of(f'"{name}";ff [m/s];dd', '2026-03-01 0{k}:00;5.0;270')
        np.testing.assert_allclose(wind, [5.0, 0.0, 0.0], atol=1e-9, err_msg=name)


@pytest.mark.parametrize('maker', WIND_MAKERS, ids=lambda each: f'{each["maker"]} {each["value"]}')
def test_every_maker_has_its_unit(maker: dict[str, object], tmp_path: Path) -> None:
    cells = {
        'year': '2026', 'mo': '3', 'dy': '{k}', 'hr': '1', 'hour': '1', 'date': '2026-03-0{k}',
        'time': '01:00', 'zeit': '2026-03-01 0{k}:00', str(maker['by']): str(maker['value']),
    }  # fmt: skip
    columns = {}
    for folded_name in str(maker['names']).split():
        name = re.sub(r'^(imperial|metricsi|metric|ukhybrid)', r'\1.', folded_name)
        ranks = {each: rank_of(name, each) is not None for each in WIND}
        usual = '2026-03-01 0{k}:00' if ranks['time'] else '1'
        usual = '14.0' if ranks['gust'] else usual
        usual = ('27' if maker['direction'] else '270') if ranks['wind_direction'] else usual
        columns[name] = '10.0' if ranks['wind_speed'] else cells.get(name, usual)
    columns |= {} if {'27', '270'} & {*columns.values()} else {'dd': '270'}
    columns |= {} if any('{k}' in each for each in columns.values()) else {'zeit': cells['zeit']}
    columns |= {} if '10.0' in columns.values() else {'ws': '10.0'}
    path = tmp_path / 'wind.csv'
    rows = [';'.join(columns.values()).replace('{k}', k) for k in '1234']
    lines = [str(maker['above'] or '#'), ';'.join(columns), *rows]
    path.write_text('\n'.join(lines), encoding='utf-8')
    if maker['speed'] == '?':
        with pytest.raises(FormatError, match='does not say the unit'):
            read_wind(path, turbulence=False)
        return
    record = read_wind(path, format='csv', turbulence=False)
    unit = unit_factor('speed', str(maker['speed']))
    np.testing.assert_allclose(record.velocity[:, 0], [10.0 * unit] * 4)


@pytest.mark.parametrize('maker', MOTION_MAKERS, ids=lambda each: each['names'])
def test_every_maker_of_motion_sensors_has_its_units(
    maker: dict[str, object], tmp_path: Path
) -> None:
    names = str(maker['names']).split()
    clock = [each for each in names if rank_of(each, 'time') is not None]
    clock = clock or ['sampletimefine' if 'packetcounter' in names else 'seconds_elapsed']
    step = 0.02 / (unit_factor('time', str(maker['time'])) if maker['time'] else 1.0)
    axes = [f'{each[:-1]}{axis}' for each in names if each[-1] in 'xz' for axis in 'xyz']
    if not axes:
        axes = ['acc_x', 'acc_y', 'acc_z', 'gyr_x', 'gyr_y', 'gyr_z']
    if 'accelerometerms20' in names:
        axes = [f'accelerometer_m_s2[{k}]' for k in range(3)]
    columns = list(dict.fromkeys([*clock, *axes, *names]))
    columns = [each for each in columns if each != 'accelerometerms20']
    lines = [str(maker['above'] or '#'), ','.join(columns)]
    for k in range(20):
        cells = dict.fromkeys(columns, '0.577') | {
            str(maker['by']): str(maker['value']),
            columns[0]: f'{1000 + k * step:.6f}', 'packetcounter': str(k),
            'rtcdate': '2026-03-01', 'rtctime': f'10:00:{0.02 * k:06.3f}',
        }  # fmt: skip
        lines.append(','.join(cells[each] for each in columns))
    path = tmp_path / 'motion.csv'
    path.write_text('\n'.join(lines), encoding='utf-8')
    record = read_motion(path)
    np.testing.assert_allclose(np.diff(record.time), 0.02, rtol=1e-6)
    for quantity in ('acceleration', 'rate'):
        values = getattr(record, quantity)
        if values is not None:
            sign = (maker['sign'] or 1) if quantity == 'acceleration' else 1
            factor = sign * (unit_factor(quantity, str(maker[quantity])) or 0.0)
            np.testing.assert_allclose(values, 0.577 * factor)
    assert record.acceleration is not None or record.rate is not None


def test_every_point_of_the_compass_is_a_direction() -> None:
    points = 'N NNE NE ENE E ESE SE SSE S SSW SW WSW W WNW NW NNW'.split()
    np.testing.assert_allclose(degrees_of(points), 22.5 * np.arange(16))


@pytest.mark.parametrize('parts', list(PARTS), ids=' '.join)
def test_every_set_of_parts_makes_a_time(parts: tuple[str, ...]) -> None:
    value = {
        'yyyymmdd': '20260301', 'hh': '{k}', 'minute': '0', 'hr': '{k}', 'hour': '{k}',
        'horamin': '{k}00', 'yy': '2026', 'yyyy': '2026', 'year': '2026', 'vuosi': '2026',
        'mm': '3', 'month': '3', 'mo': '3', 'kuukausi': '3', 'kk': '3', 'dd': '1', 'day': '1',
        'dy': '1', 'paeivae': '1', 'pv': '1', 'date': '2026-03-01', 'datum': '2026-03-01',
        'fecha': '2026-03-01', 'data': '2026-03-01', 'rtcdate': '2026-03-01', 'hh24': '{k}',
        'yearmonthdayhourminutesinyyyy': '2026', 'miformatinlocaltime': '0',
        'timestamp1': '2026-03-01', 'timestamp2': '{k}00', 'doy': '60',
        'sec': '177232320{k}', 'headerstampsec': '177232320{k}', 'headerstampsecs': '177232320{k}',
        'seconds': '177232320{k}', 'nanoseconds': '0',
        'nanosec': '0', 'headerstampnanosec': '0', 'headerstampnsecs': '0',
        'm': '3', 'd': '1', 'datapomiaru': '2026-03-01', 'godzinapomiaru': '{k}',
    }  # fmt: skip
    cells = [value.get(part, '0{k}:00') for part in parts]
    head = ';'.join([*parts, 'wind speed [m/s]', 'wind direction'])
    np.testing.assert_allclose(
        wind_of(head, ';'.join([*cells, '5.0', '270'])), [5.0, 0.0, 0.0], atol=1e-9
    )


def examples_of(pattern: str) -> list[str]:
    """Names that a pattern of motions allows: its words with each axis."""
    plain = re.sub(r'\?P<axis>|\[[^\]]*\]|\(cal\|avg\|raw\)', ' ', pattern)
    words = re.findall(r'[a-z]{2,}', plain)
    return [word for word in words if word not in ('ln', 'wr', 'ms', 'lineare', 'rad')]


@pytest.mark.parametrize('quantity', ['acceleration', 'rate'])
def test_every_name_of_a_motion_is_read(quantity: str, tmp_path: Path) -> None:
    path = tmp_path / 'motion.csv'
    unit = {'acceleration': 'g', 'rate': 'deg/s'}[quantity]
    for word in examples_of(MOTIONS[quantity].pattern):
        head = ','.join(['t', *(f'{word}_{axis} [{unit}]' for axis in 'xyz')])
        path.write_text(f'{head}\n0,0,0,1\n0.02,0,0,1\n', encoding='utf-8')
        values = getattr(read_motion(path), quantity)
        assert values is not None, word
        np.testing.assert_allclose(values[0, 2], UNITS[quantity][unit], err_msg=word)


def test_a_name_of_two_lists_is_decided_by_rule() -> None:
    claimed = defaultdict(set)
    for quantity in INVENTORY:
        for name in COLUMNS[quantity]['names']:
            claimed[folded(name)].add(quantity)
    assert {name for name, lists in claimed.items() if len(lists) > 1} == set(BY_RULE)
    table = parse_table(['genus,species,height,x,y', 'Quercus,robur,12,0,0'], 'a.csv')
    assert inventory_of(table).species == ('Quercus robur',)
    table = parse_table(['species,height,x,y', 'Quercus robur,12,0,0'], 'a.csv')
    assert inventory_of(table).species == ('Quercus robur',)
    wind = [folded(name) for each in WIND for name in COLUMNS[each]['names']]
    assert {name for name in wind if len(name) == 1} == set('tuvwxyzfsd')
    table = parse_table(['date,t,ff,dd', '2026-03-01,283.1,5.0,270'], 'a.csv')
    assert table.find('time').index == 0  # type: ignore[union-attr]


@pytest.mark.parametrize('quantity', ['height', 'diameter', 'girth', 'species', 'x', 'latitude'])
def test_every_name_of_an_inventory_is_read(quantity: str) -> None:
    for name in COLUMNS[quantity]['names']:
        columns = {
            'species': ('species', 'Quercus robur'), 'height': ('height [m]', '12.0'),
            'diameter': ('dbh [cm]', '30.0'), 'x': ('x', '2.0'), 'y': ('y', '3.0'),
        }  # fmt: skip
        if quantity == 'latitude':
            columns |= {'x': ('lon', '13.4'), 'y': (f'"{name}"', '52.5')}
        unit = unit_factor('length', own_unit(name, quantity))
        if quantity in ('height', 'diameter'):
            value = 12.0 / (unit or 1.0) if quantity == 'height' else 0.3 / (unit or 0.01)
            columns[quantity] = (f'"{name}"', repr(value))
        elif quantity == 'girth':
            columns['diameter'] = (f'"{name}"', repr(0.3 * np.pi / (unit or 0.01)))
        elif quantity in columns:
            columns[quantity] = (f'"{name}"', columns[quantity][1])
        lines = [';'.join(each[part] for each in columns.values()) for part in (0, 1)]
        found = inventory_of(parse_table(lines, 'a.csv'))
        assert found.height[0] == pytest.approx(12.0, rel=1e-6), name
        assert found.diameter[0] == pytest.approx(0.3, rel=1e-6), name
        assert found.species == ('Quercus robur',), name


@pytest.mark.parametrize('list_name', [FIA, ICP])
def test_every_code_is_a_species(list_name: str) -> None:
    for code, name in names_of(list_name).items():
        assert name_of(f'{code:03d}', list_name) == name
        assert species_like(name)[0].key


def test_no_key_occurs_twice() -> None:
    """Of two a reader of JSON takes the last, without a word."""

    def once(pairs: list[tuple[str, object]]) -> dict[str, object]:
        assert len(dict(pairs)) == len(pairs), [key for key, _ in pairs]
        return dict(pairs)

    text = (ROOT / 'columns.json').read_text('utf-8')
    assert json.loads(text, object_pairs_hook=once)
