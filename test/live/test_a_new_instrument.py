# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A new instrument is one row of the table of instruments: tried by adding one."""

from importlib import reload
from pathlib import Path

import pytest

from tree_sway import tables
from tree_sway.files import wind
from tree_sway.files.wind import instruments, Refusal
from tree_sway.live.readers import instrument_lines
from tree_sway.live.readers.instrument_lines import InstrumentLines
from tree_sway.live.transports.transport import Message

ROW = (
    r'BreezeBox,"\$BBX,\d+,(?P<wind_speed>[\d.]+),(?P<wind_direction>[\d.]+)(?P<unit>)",'
    '=kn,,,yes,no,a test\n'
)


def read_anew():
    """Load the table again, and what the face of its house had found of it."""
    reload(instruments)
    for name in ('INSTRUMENTS', 'LOGGED', 'read_instrument'):
        vars(wind).pop(name, None)
    return reload(instrument_lines)


@pytest.fixture
def lines(tmp_path, monkeypatch):
    table = Path(instruments.__file__).with_name('instruments.csv').read_text(encoding='utf-8')
    (tmp_path / 'instruments.csv').write_text(table + ROW, encoding='utf-8')
    read = tables.table_beside
    beside = str(tmp_path / 'instruments.py')
    monkeypatch.setattr(tables, 'table_beside', lambda _, name: read(beside, name))
    yield read_anew()
    monkeypatch.undo()
    read_anew()


def test_one_row_is_all_it_takes(lines):
    read = lines.InstrumentLines()
    (good,) = read(Message(b'$BBX,12,10.0,180.0\r\n'))
    assert (good.kind, good.speed) == ('BreezeBox', pytest.approx(5.144, abs=1e-3))
    assert good.velocity(0.0) == pytest.approx((0.0, 5.144, 0.0), abs=1e-3)
    (bad,) = read(Message(b'$BBX,13,10.0,400.0\r\n'))
    assert bad.reason == "direction is '400.0'"
    assert 'Vaisala WXT, Young 81000, Young 85000, BreezeBox' in lines.EXPECTS


def test_numbers_come_after_every_maker(lines):
    (found,) = lines.InstrumentLines()(Message(b'5.3,270\n'))
    assert found.speed == 5.3


@pytest.mark.parametrize(
    ('line', 'told'),
    [
        (b'0R1,Dm=270D,Sm=6.5M,Sx=9.0M', ('Vaisala WXT', 6.5, 270.0, 0.0, 9.0, None)),
        (b'0R1,Dm=270D,Sm=6.5M,Sx=9.0#', ('Vaisala WXT', 6.5, 270.0, 0.0, None, None)),
        (b'0R1,Dx=031D,Sx=36.0K', ('Vaisala WXT', 10.0, 31.0, 0.0, 10.0, None)),
        (b'0R1,Sm=10.0N', ('Vaisala WXT', 5.144, None, 0.0, None, None)),
        (b'0R1,Dm=270D,Sm=6.5#', "speed is '6.5#'"),
        (b'0R1,Dm=270D,Sm=#', "speed is '#'"),
        (b'0R1,Dm=283#,Sm=6.5M', "direction is '283#'"),
        (b'0R1,Sm=6.5M,Dm=28', "direction is ''"),
        (b'10.00 270.0 30.0 346.70 25.14', ('Young 81000', 8.660, 270.0, 5.0, None, 0.0)),
        (b'-1.00 270.0 30.0 346.70 25.14', "speed is '-1.00'"),
        (b'10.00 400.0 30.0 346.70 25.14', "direction is '400.0'"),
        (b'0 006.2 270 00*0F', ('Young 85000', 6.2, 270.0, 0.0, None, 0.0)),
        (b'0 006.2 270 00*00', 'wrong checksum'),
        (b'0 006.2 270 01*0E', "status is '01', not 00"),
    ],
)
def test_what_the_lines_of_makers_say(line, told):
    (found,) = InstrumentLines(sentence='auto')(Message(line + b'\r\n'))
    if isinstance(told, str):
        assert isinstance(found, Refusal)
        assert found.reason == told
        return
    kind, speed, degrees, up, gust, interval = told
    assert (found.kind, found.interval) == (kind, interval)
    assert found.speed == pytest.approx(speed, abs=1e-3)
    assert found.up == pytest.approx(up)
    assert found.gust == (None if gust is None else pytest.approx(gust))
    bearing = None if found.bearing is None else round(found.bearing * 57.2957795, 6)
    assert bearing == degrees
