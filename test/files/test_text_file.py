# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import time

import pytest

from tree_sway.errors import FormatError
from tree_sway.files import text_file
from tree_sway.files.column_names import motion_of, rank_of
from tree_sway.files.text_file import (
    decoded,
    finite,
    read_bytes,
    read_head,
    read_lines,
    why_no_number,
)
from tree_sway.files.trees.tree_file import read_tree
from tree_sway.files.wind.sway_table import read_csv_sway
from tree_sway.files.wind.wind_file import read_wind


@pytest.mark.parametrize(
    ('text', 'value'),
    [
        ('1', 1.0),
        (' -2.5e-3 ', -0.0025),
        ('.5', 0.5),
        ('5.', 5.0),
        ('+1E2', 100.0),
        ('\x1e1', 1.0),
    ],
)
def test_plain_numbers(text, value):
    assert finite(text) == value


@pytest.mark.parametrize(
    'text',
    ['', ' ', 'nan', 'INF', '1e999', '1_0', '0x1', '1,5', '1 m', '--1', 'e5', '.', '\u0663'],
)
def test_all_else_is_none(text):
    assert finite(text) is None


@pytest.mark.parametrize(
    ('text', 'page'),
    [
        ('Baumhöhe;Größe;„Straße‚ ƒ“ – ÄÖÜ ßßß', 'cp1252'),
        ('Ulice;ÀÁÂÃ;È±°¿ Ærø à côté', 'cp1252'),
        ('番号,樹種\n1,ケヤキ\n', 'cp932'),
        ('지점,풍속(m/s)\n', 'cp949'),
        ('수목번호,수종,수고,흉고직경\n1,소나무,12,30\n비고: 南쪽 도로\n', 'cp949'),
        ('小时,温度,风力方向,风级\n东南风,西北风\n', 'gb18030'),
    ],
)
def test_the_code_page_is_told_by_the_text(text, page):
    assert decoded(text.encode(page)) == text


def test_line_ends(tmp_path):
    (tmp_path / 'a').write_bytes(b'\xef\xbb\xbfone\r\ntwo\rthree\nfour')
    assert read_lines(tmp_path / 'a') == ['one', 'two', 'three', 'four']
    assert read_head(tmp_path / 'a').startswith('one')


def test_a_huge_file_is_refused_before_it_is_read(tmp_path, monkeypatch):
    monkeypatch.setattr(text_file, 'MAX_BYTES', 10)
    (tmp_path / 'a').write_bytes(b'x' * 11)
    with pytest.raises(FormatError, match='larger than 0 MiB'):
        read_bytes(tmp_path / 'a')
    assert len(read_bytes(tmp_path / 'a', at_most=4)) == 4


@pytest.mark.parametrize(
    ('text', 'reason'),
    [
        ('1,5', "'1,5', with a decimal comma: export it with decimal points"),
        ('-,5e3', "'-,5e3', with a decimal comma: export it with decimal points"),
        (' x ', "'x', not a finite number"),
    ],
)
def test_why_no_number(text, reason):
    assert why_no_number(text) == reason


MTG = 'CODE:\tFORM-A\nSYMBOL\tSCALE\nP\t1\nENTITY-CODE\t\tXX\n'
NASTY = {
    'cell.csv': lambda digits: (
        f'segment,parent,x0,y0,z0,x1,y1,z1,d0\n0,-1,0,0,0,0,0,1,{digits}x\n'
    ),
    'node.yaml': lambda digits: f'branches: [{{name: a, nodes: [[0, 0, 0, {digits}x]]}}]\n',
    'wind.csv': lambda digits: f'time,u,v\n0,{digits}x,1\n',
    'wind.nmea': lambda digits: f'$WIMWV,{digits}x,R,1,M,A\n',
    'code.mtg': lambda digits: f'{MTG}/P{digits}!\n',
    'sway.csv': lambda digits: f'time,x{digits.replace("1", " a")}!\n0,1\n',
    'point.swc': lambda digits: f'1 1 0 0 0 1 -1\n2 1 0 0 {digits}.{digits}x 1 1\n',
}


@pytest.mark.parametrize('name', NASTY)
def test_twice_the_digits_take_twice_the_time(tmp_path, name):
    read = read_csv_sway if name[:4] == 'sway' else read_wind if name[:4] == 'wind' else read_tree

    def seconds(n):
        path = tmp_path / name
        path.write_text(NASTY[name]('1' * n))
        best = float('inf')
        for _ in range(3):
            begin = time.process_time()
            with pytest.raises(FormatError):
                read(path)
            best = min(best, time.process_time() - begin)
        return best

    # Parts that do not grow are made small by the length: the old patterns took minutes for these.
    assert seconds(200_000) <= 3.0 * seconds(100_000) + 0.01


@pytest.mark.usefixtures('little_effort')
def test_a_header_without_end_takes_little() -> None:
    """Each of its words was compared with all units."""
    endless = f'x{" a" * 400_000}'
    assert motion_of(endless) is None
    assert rank_of(endless, 'wind_speed') is None
