# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Small files that claim much: refused within 5 s of a processor and 1 GiB of memory."""

from collections.abc import Callable, Iterator
import io
from pathlib import Path
import sqlite3
import struct
import subprocess
import sys
import zipfile
import zlib

import pytest
from scipy.io import savemat

READ = """
import os, resource, signal, sys
os.environ['OPENBLAS_NUM_THREADS'] = '1'
from tree_sway.errors import TreeSwayError
from tree_sway.files.trees.source import open_scene
from tree_sway.files.trees.tree_file import read_trees
from tree_sway.files.wind.wind_file import read_wind
for line in sys.stdin:
    path, kind, seconds, said = line.rstrip('\\n').split('\\t')
    child = os.fork()
    if child:
        print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), flush=True)
        continue
    signal.alarm(60)
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
    for number in (1, 2):
        os.dup2(os.open(f'{said}.{number}', os.O_WRONLY | os.O_CREAT), number)
    resource.setrlimit(resource.RLIMIT_AS, (1 << 30, 1 << 30))
    resource.setrlimit(resource.RLIMIT_CPU, (int(seconds) + 1, int(seconds) + 1))
    try:
        {'wind': read_wind, 'tree': read_trees, 'scene': open_scene}[kind](path)
    except TreeSwayError as error:
        print(error)
    break
"""
"""Reads each file in a process of its own, which has the modules and no more time than told."""

Reader = Callable[[Path, str, int], tuple[int, str, str]]


@pytest.fixture(scope='module')
def read(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Reader]:
    """Read a file; return the exit status, what was said and what was written to errors."""
    said = tmp_path_factory.mktemp('said')
    command = [sys.executable, '-c', READ]
    pipe = subprocess.PIPE
    with subprocess.Popen(command, stdin=pipe, stdout=pipe, text=True, bufsize=1) as server:
        assert server.stdin is not None
        assert server.stdout is not None
        asked, answers = server.stdin, server.stdout

        def ask(path: Path, kind: str, seconds: int) -> tuple[int, str, str]:
            out = said / path.name
            asked.write(f'{path}\t{kind}\t{seconds}\t{out}\n')
            status = int(answers.readline())
            spoken, errors = (Path(f'{out}.{number}').read_text() for number in (1, 2))
            return status, spoken, errors

        yield ask
        asked.close()
        assert server.wait(60) == 0


def record(kind: int, body: bytes) -> bytes:
    return struct.pack('<BQ', kind, len(body)) + body


def chunk(name: bytes, packed: bytes, size: int) -> bytes:
    head = struct.pack('<QQQII', 0, 0, size, 0, len(name)) + name
    return record(0x06, head + struct.pack('<Q', len(packed)) + packed)


MCAP = b'\x89MCAP0\r\n'


def mcap(records: bytes) -> bytes:
    """Return a file without an index, which is scanned from its beginning."""
    header = record(0x01, struct.pack('<I', 4) + b'ros2' + struct.pack('<I', 0))
    return MCAP + header + records + record(0x02, bytes(20)) + MCAP


def chunks_in_chunks(path: Path) -> None:
    inside = b''
    for _ in range(30):
        inside = chunk(b'', inside, len(inside))
    path.write_bytes(mcap(inside))


def zstd_of(size: int) -> bytes:
    zstd = pytest.importorskip('backports.zstd', reason='rosbags is not installed')
    engine, packed = zstd.ZstdCompressor(), []
    for _ in range(size >> 24):
        packed.append(engine.compress(bytes(1 << 24)))
    return b''.join([*packed, engine.flush()])


def packed_chunk(path: Path) -> None:
    size = 1 << 30
    path.write_bytes(mcap(chunk(b'zstd', zstd_of(size), size)))


def packed_bag(path: Path) -> None:
    rosbag2 = pytest.importorskip('rosbags.rosbag2', reason='rosbags is not installed')
    writer = rosbag2.Writer(path, version=9, storage_plugin=rosbag2.StoragePlugin.MCAP)
    writer.set_compression(rosbag2.CompressionMode.FILE, rosbag2.CompressionFormat.ZSTD)
    with writer:
        pass
    (file,) = path.glob('*.zstd')
    file.write_bytes(zstd_of(1 << 30))


def database(path: Path, messages: str) -> None:
    base = sqlite3.connect(path)
    base.execute('CREATE TABLE topics (id, name, type, serialization_format)')
    base.execute("INSERT INTO topics VALUES (1, '/wind', 'geometry_msgs/msg/Vector3', 'cdr')")
    base.execute(messages)
    if messages.startswith('CREATE TABLE'):
        base.execute('INSERT INTO messages (topic_id, timestamp) VALUES (1, 1)')
    base.commit()
    base.close()


def view_without_end(path: Path) -> None:
    database(
        path,
        'CREATE VIEW messages AS WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) '
        'SELECT 1 AS topic_id, i AS timestamp, zeroblob(1000000) AS data FROM n',
    )


def computed_column(path: Path) -> None:
    database(
        path, 'CREATE TABLE messages (id, topic_id, timestamp, data AS (zeroblob(900000000)))'
    )


def element(kind: int, body: bytes) -> bytes:
    return struct.pack('<II', kind, len(body)) + body


def matlab(path: Path, count: int) -> None:
    """Write a cell array of n empty arrays, compressed."""
    empty = element(
        14, element(6, struct.pack('<II', 6, 0)) + element(5, bytes(8)) + element(1, b'')
        + element(9, b''),
    )  # fmt: skip
    head = element(6, struct.pack('<II', 1, 0)) + element(5, struct.pack('<2i', 1, count))
    packed = zlib.compress(element(14, head + element(1, b'QSM\0\0\0\0\0') + empty * count), 9)
    stream = io.BytesIO()
    savemat(stream, {})
    path.write_bytes(stream.getvalue()[:128] + struct.pack('<II', 15, len(packed)) + packed)


def many_cells(path: Path) -> None:
    matlab(path, 400_000)
    assert path.stat().st_size < 400_000


def line_ends(path: Path) -> None:
    path.write_bytes(b'time,u,v\n0,1,2\n' + b'\n' * 200_000_000)


def million_keys(path: Path) -> None:
    path.write_text('branches:\n' + '\n'.join(f'k{i}: 1' for i in range(1_000_000)))


def geopackage(path: Path, table: object, *statements: str) -> None:
    base = sqlite3.connect(path)
    base.execute('CREATE TABLE gpkg_contents (table_name, data_type)')
    base.execute('CREATE TABLE gpkg_geometry_columns (table_name, column_name, srs_id)')
    base.execute("INSERT INTO gpkg_contents VALUES (?, 'features')", (table,))
    base.execute("INSERT INTO gpkg_geometry_columns VALUES (?, 'geom', 0)", (table,))
    for each in statements:
        base.execute(each)
    base.commit()
    base.close()


def layer_without_end(path: Path) -> None:
    rows = 'WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n)'
    view = f"CREATE VIEW trees AS {rows} SELECT i AS geom, 'oak' AS species FROM n WHERE i < 0"
    geopackage(path, 'trees', view)


def giant_cell(path: Path) -> None:
    blobs = ', '.join(f'zeroblob(900000000) AS {name}' for name in ('geom', 'species', 'height'))
    geopackage(path, 'trees', f'CREATE VIEW trees AS SELECT {blobs}')


def blob_as_name(path: Path) -> None:
    geopackage(path, b'\0\1', 'CREATE TABLE trees (geom, species, height)')


def geometry_cut_off(path: Path) -> None:
    rows = "INSERT INTO trees VALUES (x'47500001', 'oak', 12), (x'4750000100000000', 'oak', 9)"
    geopackage(path, 'trees', 'CREATE TABLE trees (geom, species, height)', rows)


def spreadsheet(path: Path, part: str, body: Iterator[bytes]) -> None:
    """Write a spreadsheet of which a part is replaced."""
    openpyxl = pytest.importorskip('openpyxl', reason='the extra inventory is not installed')
    stream = io.BytesIO()
    openpyxl.Workbook().save(stream)
    bad = zipfile.ZipFile(path, 'w', zipfile.ZIP_DEFLATED, compresslevel=1)
    with zipfile.ZipFile(stream) as good, bad:
        for each in good.namelist():
            with bad.open(each, 'w', force_zip64=True) as file:
                for data in body if each == part else [good.read(each)]:
                    file.write(data)


SHEET = 'xl/worksheets/sheet1.xml'


def packed_sheet(path: Path) -> None:
    spreadsheet(path, SHEET, (bytes(1 << 24) for _ in range(60)))


def laughs(path: Path) -> None:
    entities = ''.join(f'<!ENTITY a{i} "{f"&a{i - 1};" * 10}">' for i in range(1, 12))
    head = f'<?xml version="1.0"?><!DOCTYPE b [<!ENTITY a0 "ha">{entities}]>'
    body = '<worksheet><sheetData><row><c t="inlineStr"><is><t>&a11;</t></is></c></row>'
    spreadsheet(path, SHEET, iter([f'{head}{body}</sheetData></worksheet>'.encode()]))


def sheet_of(path: Path, entities: str, text: str) -> None:
    head = f'<?xml version="1.0"?><!DOCTYPE b [{entities}]>'
    body = f'<worksheet><sheetData><row><c t="inlineStr"><is><t>{text}</t></is></c></row>'
    spreadsheet(path, SHEET, iter([f'{head}{body}</sheetData></worksheet>'.encode()]))


def file_of_others(path: Path) -> None:
    sheet_of(path, '<!ENTITY a SYSTEM "file:///etc/passwd">', '&a;')


def blown_up(path: Path) -> None:
    sheet_of(path, f'<!ENTITY a "{"ha" * 50_000}">', '&a;' * 50_000)


def strings_without_end(path: Path) -> None:
    head = b'<sst xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main">'
    strings = (b'<si><t>oak</t></si>' * 100_000 for _ in range(40))
    spreadsheet(path, 'xl/sharedStrings.xml', iter([head, *strings]))


def zip_of(path: Path, name: str, size: int, count: int) -> None:
    with zipfile.ZipFile(path, 'w', zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
        for k in range(count):
            archive.writestr(f'{k}{name}', bytes(size))


def packed_table(path: Path) -> None:
    zip_of(path, '.csv', 1 << 28, 3)


def packed_tables(path: Path) -> None:
    zip_of(path, '.csv', 10, 5000)


def zip_with_a_wrong_size(path: Path) -> None:
    zip_of(path, '.csv', 1 << 28, 1)
    data = bytearray(path.read_bytes())
    for sign, at in ((b'PK\3\4', 22), (b'PK\1\2', 24)):
        struct.pack_into('<I', data, data.index(sign) + at, 100)
    path.write_bytes(data)


BOMBS: dict[str, tuple[Callable[[Path], None], str]] = {
    'chunks.mcap': (chunks_in_chunks, 'Nested MCAP chunks'),
    'packed.mcap': (packed_chunk, 'more than 768 MiB of memory or 20 s'),
    'packed': (packed_bag, 'File too large'),
    'view.db3': (view_without_end, 'missing tables'),
    'computed.db3': (computed_column, 'not a bag that can be read'),
    'endless.gpkg': (layer_without_end, 'more than 768 MiB of memory or 20 s'),
    'giant.gpkg': (giant_cell, 'string or blob too big'),
    'name.gpkg': (blob_as_name, 'a layer whose name is no text'),
    'cut.gpkg': (geometry_cut_off, 'no layer of points'),
    'packed.xlsx': (packed_sheet, 'more than 768 MiB when it is unpacked'),
    'laughs.xlsx': (laughs, 'not a spreadsheet that can be read'),
    'others.xlsx': (file_of_others, 'not a spreadsheet that can be read'),
    'blown.xlsx': (blown_up, 'not a spreadsheet that can be read'),
    'strings.xlsx': (strings_without_end, 'no sheet with a header and rows'),
    'table.zip': (packed_table, 'tables of more than 64 MiB in a zip'),
    'tables.zip': (packed_tables, 'a zip of 5000 files'),
    'wrong.zip': (zip_with_a_wrong_size, 'a zip that cannot be read'),
    'cells.mat': (many_cells, 'more than 100000 arrays'),
    'ends.csv': (line_ends, 'more than 4000000 lines'),
    'keys.yaml': (million_keys, 'more than 600000 keys and values'),
}


@pytest.mark.parametrize('name', BOMBS)
def test_a_bomb_is_refused_in_one_line(name: str, tmp_path: Path, read: Reader) -> None:
    make, reason = BOMBS[name]
    if name.startswith('packed') or name.endswith(('.mcap', '.db3')):
        pytest.importorskip('rosbags', reason='rosbags is not installed')
    make(tmp_path / name)
    kind = 'tree' if name.endswith(('.mat', '.yaml')) else 'wind'
    kind = 'scene' if name.endswith(('.gpkg', '.xlsx')) else kind
    # What has no end takes as long as it may, which the process that reads it inherits.
    seconds = 2 if name.startswith('endless') else 5
    status, spoken, errors = read(tmp_path / name, kind, seconds)
    assert (status, errors) == (0, '')
    assert reason in spoken
    assert len(spoken) < 700


@pytest.mark.parametrize(
    'text',
    ['x' * 5000, '\x1b[2J\x07' * 100, 'a\nb\r\nc\td' * 50],
    ids=['long', 'escapes', 'lines'],
)
def test_cells_of_a_file_are_cut_and_escaped_in_messages(text: str, tmp_path: Path) -> None:
    from tree_sway.errors import TreeSwayError
    from tree_sway.files.trees.tree_file import read_tree

    path = tmp_path / 'a.yaml'
    path.write_text('species: "' + text.encode('unicode_escape').decode() + '"\nbranches: []\n')
    with pytest.raises(TreeSwayError) as raised:
        read_tree(path)
    assert str(raised.value).isprintable()
    assert len(str(raised.value)) < 2000
