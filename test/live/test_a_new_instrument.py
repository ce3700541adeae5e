# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A new instrument is one module in the folder of makers: tried by adding one."""

from importlib import import_module, reload

import pytest

from tree_sway.live.readers import instrument_lines, makers
from tree_sway.live.transports.transport import Message

MODULE = '''
"""Lines of a maker of a test: ``$BBX,milliseconds,speed in kn,direction``."""

import math

from tree_sway.live.reading import LineFormat, Reading, Refusal, WindReading

KNOT = 1852.0 / 3600.0


def read_breezebox(line: str, heading: float, factor: float) -> Reading | None:
    """Read a line, whose directions are from true north."""
    if not line.startswith('$BBX,'):
        return None
    _, _, speed, direction = line.split(',')
    if float(direction) > 360.0:
        return Refusal('BreezeBox', f'direction is {direction}')
    return WindReading('BreezeBox', KNOT * float(speed), math.radians(float(direction)))


LINES = LineFormat('BreezeBox', read_breezebox)
'''


@pytest.fixture
def lines(tmp_path, monkeypatch):
    (tmp_path / 'breezebox.py').write_text(MODULE)
    monkeypatch.setattr(makers, '__path__', [*makers.__path__, str(tmp_path)])
    yield reload(instrument_lines)
    monkeypatch.undo()
    reload(instrument_lines)


def test_one_module_is_all_it_takes(lines):
    read = lines.InstrumentLines()
    (good,) = read(Message(b'$BBX,12,10.0,180.0\r\n'))
    assert (good.kind, good.speed) == ('BreezeBox', pytest.approx(5.144, abs=1e-3))
    assert good.velocity(0.0) == pytest.approx((0.0, 5.144, 0.0), abs=1e-3)
    (bad,) = read(Message(b'$BBX,13,10.0,400.0\r\n'))
    assert bad.reason == 'direction is 400.0'
    assert 'Vaisala WXT, Young' in lines.EXPECTS
    assert 'BreezeBox' in lines.EXPECTS


def test_numbers_come_after_every_maker(lines):
    (found,) = lines.InstrumentLines()(Message(b'5.3,270\n'))
    assert found.speed == 5.3
    names = {each.name for each in lines._MAKERS}
    assert {'BreezeBox', 'Vaisala WXT', 'Young'} <= names
    assert import_module('tree_sway.live.readers.makers.young').LINES.name == 'Young'
