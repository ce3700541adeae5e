# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Any line at all: wind that is finite, a refusal or nothing, and never an exception."""

import math
import random

import pytest

from tree_sway.files.wind.instruments import read_instrument
from tree_sway.files.wind.nmea import parse_nmea
from tree_sway.files.wind.reading import Refusal, WindReading

GOOD = [
    '$IIMWV,270.0,T,10.0,M,A*0C',
    '$WIMWD,270.0,T,265.0,M,19.438,N,10.0,M*58',
    '$IIVWR,045.0,L,12.6,N,6.5,M,23.3,K*52',
    '$IIVWT,030.0,R,10.1,N,5.2,M,18.7,K*4C',
    '\x02Q,270,010.00,M,00,\x0318',
    '\x02A,+003.00,+004.00,+001.00,M,+345.01,+022.36,00,\x0300',
]
PIECES = [
    '',
    ',',
    '*',
    '$',
    '\x02',
    '\x03',
    '\x00',
    '\ud800',
    'é',
    'nan',
    'inf',
    '1e308',
    '-1e308',
    '-0',
    '9' * 400,
    'R',
    'T',
    'L',
    'N',
    'M',
    'A',
    'V',
    '00',
    ' ',
    '\r\n',
    'U',
    'D',
    '*ZZ',
    '*1',
]


def fuzzed(rng: random.Random) -> str:
    line = rng.choice(GOOD)
    for _ in range(rng.randint(0, 4)):
        at, until = sorted((rng.randrange(len(line) + 1), rng.randrange(len(line) + 1)))
        kind = rng.random()
        if kind < 0.4:
            line = line[:at] + rng.choice(PIECES) + line[at:]
        elif kind < 0.7:
            fields = line.split(',')
            fields[rng.randrange(len(fields))] = rng.choice(PIECES)
            line = ','.join(fields)
        elif kind < 0.85:
            line = line[:at] + line[until:]
        else:
            line = line[:at] + chr(rng.randrange(256)) + line[at + 1 :]
    return line


def fuzz(n_lines: int, seed: int) -> tuple[int, int]:
    """Numbers of lines that were taken and that were refused."""
    rng = random.Random(seed)
    taken = refused = 0
    for _ in range(n_lines):
        line = fuzzed(rng)
        for said in (parse_nmea(line), read_instrument(line)):
            if said is None:
                continue
            if isinstance(said, Refusal):
                assert 0 < len(said.reason) < 200
                refused += 1
            else:
                assert isinstance(said, WindReading)
                assert all(math.isfinite(value) for value in said.velocity(0.0))
                taken += 1
    return taken, refused


def test_twenty_thousand_lines():
    taken, refused = fuzz(20_000, 1)
    assert taken > 1000
    assert refused > 1000


@pytest.mark.long
def test_a_million_lines():
    taken, refused = fuzz(1_000_000, 2)
    assert taken > 50_000
    assert refused > 50_000
