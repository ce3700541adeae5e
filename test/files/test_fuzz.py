# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Damaged files: a clear error or a sound result, never a crash, a hang or a memory gone."""

import os
from pathlib import Path
import random
import resource
import sqlite3
import time

from hypothesis import given, HealthCheck, settings
from hypothesis import strategies as st
import numpy as np
import pytest
from scipy.io import savemat
from tree_sway_lab.fuzz.mutation import drawn, KINDS, mutated, TOKENS

from tree_sway.core.setup import prepare
from tree_sway.errors import TreeSwayError
from tree_sway.files.models import read_model, write_model
from tree_sway.files.motion import read_motion
from tree_sway.files.scenes import inventory_of, inventory_table, read_critical_winds
from tree_sway.files.scenes.scene_yaml import parse_scene
from tree_sway.files.text_file import read_head
from tree_sway.files.trees import LearnedFile
from tree_sway.files.trees.formats.treeqsm import read_treeqsm_text
from tree_sway.files.trees.source import open_scene, open_tree
from tree_sway.files.trees.tree_file import read_trees, TREE_FORMATS
from tree_sway.files.trees.yaml.tree_yaml import read_species
from tree_sway.files.wind import read_csv_sway
from tree_sway.files.wind.wind_file import read_wind, WIND_FORMATS

DATA = Path(__file__).parent / 'data'
WINDS = [
    'sonic.toa5.dat',
    'mast.nmea',
    'weather.nmea',
    'wind.csv',
    'wind_components.csv',
    'wind.db3',
    'wind.mcap',
]
LARGE = ['tree121.csv', 'canopy.toa5.dat']
TREES = [
    *sorted(path.name for path in DATA.iterdir() if path.name not in (*WINDS, *LARGE)),
    'fork5.mat',
    'fork7.mat',
    'glade.yaml',
]

SEEDLING = open_tree(DATA / 'seedling.yaml')
MUTATION = st.tuples(
    st.sampled_from(KINDS),
    st.floats(0.0, 1.0, exclude_max=True),
    st.floats(0.0, 1.0, exclude_max=True),
    st.sampled_from(TOKENS),
)


@pytest.fixture(scope='module')
def samples(tmp_path_factory):
    """Content of a good file of each kind; of some only where what writes them is installed."""
    folder = tmp_path_factory.mktemp('samples')
    content = {path.name: path.read_bytes() for path in DATA.iterdir() if path.is_file()}
    (cylinders,) = read_treeqsm_text(DATA / 'fork.treeqsm24.txt')
    axis = cylinders.end - cylinders.start
    columns = {'radius': cylinders.diameter[:, 0] / 2, 'length': np.linalg.norm(axis, axis=1),
               'start': cylinders.start, 'axis': axis, 'parent': [0, 1, 1, 2],
               'extension': [3, 4, 0, 0]}  # fmt: skip
    for name, compressed in (('fork5.mat', False), ('fork7.mat', True)):
        savemat(folder / name, {'QSM': {'cylinder': columns}}, do_compression=compressed)
        content[name] = (folder / name).read_bytes()
    content['glade.yaml'] = b"""name: glade
anemometer: [0, 0, 10]
trees:
- {name: a, tree: segments.csv, x: 1, y: -2.5, yaw: .3, leaf_on: true}
- {name: b, tree: ./segments.csv, species: oak, z: 1e1}
"""
    content.update(bags(folder))
    return content


def bags(folder: Path) -> dict[str, bytes]:
    try:
        from rosbags.rosbag2 import StoragePlugin, Writer
        from rosbags.typesys import get_typestore, Stores
    except ImportError:
        return {}
    store = get_typestore(Stores.ROS2_JAZZY)
    kind = 'geometry_msgs/msg/Vector3'
    result = {}
    for plugin, suffix in ((StoragePlugin.SQLITE3, 'db3'), (StoragePlugin.MCAP, 'mcap')):
        with Writer(folder / suffix, version=9, storage_plugin=plugin) as writer:
            connection = writer.add_connection('/wind', kind, typestore=store)
            for second in range(3):
                message = store.types[kind](1.0 * second, 2.0, 0.0)
                writer.write(connection, second * 10**9, store.serialize_cdr(message, kind))
        (file,) = (folder / suffix).glob(f'*.{suffix}')
        result[f'wind.{suffix}'] = file.read_bytes()
    return result


def assert_sound_tree(tree) -> None:
    arrays = [
        tree.start,
        tree.end,
        tree.base_diameter,
        tree.tip_diameter,
        tree.length,
        tree.volume,
    ]
    assert all(np.isfinite(array).all() for array in arrays)
    assert (tree.length > 0).all()
    assert (tree.base_diameter > 0).all()
    assert (tree.tip_diameter > 0).all()
    assert (tree.segment_parent < np.arange(tree.n_segments)).all()
    assert np.count_nonzero(tree.segment_parent < 0) == 1


def assert_sound_wind(record) -> None:
    assert len(record.time) == len(record.velocity) > 0
    assert (np.diff(record.time) > 0).all()
    assert np.isfinite(record.velocity).all()
    assert (record.refused == 0) == (record.first_refused == '')


def check(path: Path, name: str, content: bytes, kind: str | None) -> None:
    path.write_bytes(content)
    begin = time.process_time()
    taken = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    message = 'none'
    try:
        if name in WINDS:
            assert_sound_wind(read_wind(path, format=kind))
        else:
            if name == 'glade.yaml':
                text = path.read_text(errors='replace')
                trees = parse_scene(text, lambda *_: SEEDLING, Path(name)).trees
            else:
                trees = read_trees(path, format=kind)
            for tree_file in trees:
                assert_sound_tree(tree_file.tree)
    except TreeSwayError as error:
        message = str(error)
    assert message
    assert '\n' not in message
    assert time.process_time() - begin < 5.0
    # KiB: 1 GiB, or no more than tests before this one have taken already.
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss <= max(2**20, taken)


def fuzz(samples, folder: Path, n_examples: int) -> None:
    """Mutate files; half of them are read by a format that is named and often not their own."""
    formats = {name: [f.name for f in (WIND_FORMATS if name in WINDS else TREE_FORMATS)]
               for name in (*TREES, *WINDS)}  # fmt: skip
    there = [name for name in (*TREES, *WINDS) if name in samples]

    @settings(max_examples=n_examples, deadline=None, database=None,
              suppress_health_check=[HealthCheck.too_slow])  # fmt: skip
    @given(
        name=st.sampled_from(there),
        mutations=st.lists(MUTATION, min_size=1, max_size=6),
        named=st.integers(0, 20),
    )
    def run(name, mutations, named):
        kind = None if named > 9 else formats[name][named % len(formats[name])]
        content = mutated(samples[name], mutations)
        check(folder / f'file{Path(name).suffix}', name, content, kind)

    run()


@pytest.mark.filterwarnings('ignore::RuntimeWarning', 'ignore::UserWarning')
def test_some_damaged_files(samples, tmp_path):
    fuzz(samples, tmp_path, 100)


def read_inventory(path: Path) -> None:
    table = inventory_of(inventory_table(path, read_head(path)), needs_place=False)
    assert np.isfinite([table.x, table.y, table.z, table.height]).all()
    assert len(set(table.names)) == len(table.names) > 0


def read_scene(path: Path) -> None:
    scene = open_scene(path, warn=False)
    for placed in scene.trees:
        assert_sound_tree(placed.tree)
        assert np.isfinite([placed.x, placed.y, placed.z, placed.yaw]).all()


def read_moved(path: Path) -> None:
    record = read_motion(path)
    told = [record.acceleration, record.rate, record.orientation]
    told = [each for each in told if each is not None]
    assert told
    # A sample of a cell that is no number is NaN; a sensor refuses and counts it.
    assert all(len(each) == len(record.time) > 0 for each in told)
    assert np.isfinite(record.time).any()


def read_prepared(path: Path) -> None:
    simulator = read_model(path).simulator()
    simulator.step((5.0, 0.0, 0.0), 1.0 / 60.0)
    assert np.isfinite(simulator.place()).all()


def read_sway(path: Path) -> None:
    record = read_csv_sway(path)
    assert np.isfinite(record.time).all()


READERS = {
    'wind': lambda path: assert_sound_wind(read_wind(path)),
    'motion': read_moved,
    'trees': lambda path: [assert_sound_tree(each.tree) for each in read_trees(path)],
    'scene': read_scene,
    'inventory': read_inventory,
    'model': read_prepared,
    'sway': read_sway,
    'learned': lambda path: LearnedFile(str(path), SEEDLING),
    'species': read_species,
    'critical': read_critical_winds,
}
"""Every reader of a file, with what holds for all that it takes."""
OWN = {
    'inv': ('inventory', 'scene'),
    'tree': ('trees', 'scene'),
    'trees': ('trees', 'scene'),
    'wind': ('wind',),
    'motion': ('motion',),
}
"""Readers of the files in a folder of that name."""
USERS = Path(__file__).parents[2] / '..' / 'shared' / 'data'
LARGEST = 100_000
"""Bytes of a file that is damaged."""


def files_of_every_reader(samples, folder: Path) -> list[tuple[str, bytes, tuple[str, ...]]]:
    """Name, content and readers of good files."""
    found = [(name, content, ('wind',) if name in WINDS else ('trees', 'scene'))
             for name, content in samples.items() if name not in LARGE]  # fmt: skip
    for path in sorted(USERS.rglob('*')):
        own = OWN.get(path.parent.name)
        if own and path.is_file() and path.stat().st_size < LARGEST:
            found.append((path.name, path.read_bytes(), own))
    write_model(folder / 'seedling.npz', prepare(SEEDLING.tree, SEEDLING.species))
    found.append(('seedling.npz', (folder / 'seedling.npz').read_bytes(), ('model', 'trees')))
    with sqlite3.connect(folder / 'park.gpkg') as rows:
        rows.executescript("""
PRAGMA application_id = 1196444487;
CREATE TABLE gpkg_contents (table_name TEXT, data_type TEXT, identifier TEXT, srs_id INTEGER);
CREATE TABLE gpkg_geometry_columns (table_name TEXT, column_name TEXT, srs_id INTEGER);
CREATE TABLE park (geom BLOB, species TEXT, height REAL, dbh REAL);
INSERT INTO gpkg_contents VALUES ('park', 'features', 'park', 25833);
INSERT INTO gpkg_geometry_columns VALUES ('park', 'geom', 25833);
INSERT INTO park VALUES (x'475000010000000001010000000000000000000000' ||
    x'0000000000000000', 'oak', 12.0, 30.0);
""")
    rows.close()
    texts = {
        'park.csv': ('name,species,x,y,height,dbh\na,oak,0,0,12 m,30 cm\nb,ash,9,4,15 m,25/20\n',
                     ('inventory', 'scene')),
        'park.geojson': ('{"type": "FeatureCollection", "features": [{"type": "Feature", '
                         '"geometry": {"type": "Point", "coordinates": [13.4, 52.5]}, '
                         '"properties": {"species": "Quercus robur", "height": 12}}]}',
                         ('inventory', 'scene')),
        'imu.csv': ('time [s],ax [m/s^2],ay [m/s^2],az [m/s^2]\n'
                    + ''.join(f'{k / 50},{k % 3 / 10},0.0,9.81\n' for k in range(40)),
                    ('motion',)),
        'sway.csv': ('time [s],x [m],y [m],z [m]\n'
                     + ''.join(f'{k / 50},{k % 3 / 10},0,8\n' for k in range(40)), ('sway',)),
        'oak.species.yaml': ((DATA / 'seedling.yaml').read_text(), ('learned', 'species')),
        'risk.csv': ('name,low_80 [m/s],high_80 [m/s]\na,20,30\nb,,\n', ('critical',)),
    }  # fmt: skip
    found.append(('park.gpkg', (folder / 'park.gpkg').read_bytes(), ('inventory', 'scene')))
    return found + [(name, text.encode(), own) for name, (text, own) in texts.items()]


def resident() -> float:
    """Memory of this process in [MiB]."""
    return int(Path('/proc/self/statm').read_text().split()[1]) * resource.getpagesize() / 2**20


@pytest.mark.long
@pytest.mark.filterwarnings('ignore')
def test_damaged_files_of_every_reader(samples, tmp_path):
    """For ``TREE_SWAY_FUZZ_SECONDS``; files that fail are left in the folder of the test."""
    rng = random.Random(int(os.environ.get('TREE_SWAY_FUZZ_SEED', '1')))
    good = files_of_every_reader(samples, tmp_path)
    seconds = float(os.environ.get('TREE_SWAY_FUZZ_SECONDS', '180'))
    begin, number, refused, warm, faults = time.monotonic(), 0, 0, 0.0, []
    while (passed := time.monotonic() - begin) < seconds and len(faults) < 20:
        warm = resident() if passed < seconds / 4 else warm
        name, content, own = rng.choice(good)
        reader = rng.choice(own if rng.random() < 0.9 else [*READERS])
        path = tmp_path / f'{number}.{name}'
        path.write_bytes(mutated(content, drawn(rng)))
        fault, is_refused = fault_of(READERS[reader], path)
        if fault:
            faults.append(f'{reader} of {path}: {fault}')
        else:
            path.unlink()
        number += 1
        refused += is_refused
    print(f'{number} files of {len(good)} kinds in {passed:.0f} s, {refused} refused, memory '
          f'{warm:.0f} MiB after a quarter and {resident():.0f} MiB at the end')  # fmt: skip
    assert not faults, '\n'.join(faults)
    assert resident() < warm + 100.0


def fault_of(read, path: Path) -> tuple[str, bool]:
    """Find what is wrong with how a reader takes a file, and whether it refuses the file."""
    begin, taken = time.process_time(), resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    message = None
    try:
        read(path)
    except TreeSwayError as error:
        message = str(error)
        if not message or '\n' in message:
            return f'says {message!r}', True
    except Exception as error:
        return f'{type(error).__name__}: {error}', False
    if (used := time.process_time() - begin) > 5.0:
        return f'takes {used:.1f} s', message is not None
    if resource.getrusage(resource.RUSAGE_SELF).ru_maxrss > max(2**20, taken):
        return 'takes more than 1 GiB', message is not None
    return '', message is not None


@pytest.mark.parametrize(
    ('suffix', 'content'),
    [
        ('.yaml', b'branches: ' + b'[' * 200_000),
        ('.yaml', b'branches:\n' + b'- ' * 200_000),
        (
            '.yaml',
            b'branches: [{name: a, segments: ['
            + b'{start: [0, 0, 0], end: [0, 0, 1], diameter: 1},' * 5_000
            + b']}]',
        ),
        ('.csv', b'segment,parent,x0,y0,z0,x1,y1,z1,d0\n' + b'0,-1,"' + b'0' * 1_000_000),
        ('.swc', b'\n'.join(b'%d 1 0 0 %d 1 %d' % (i, i, i - 1 or -1) for i in range(1, 20_000))),
        (
            '.swc',
            b'1 1 0 0 0 1 -1\n' + b'\n'.join(b'%d 1 0 0 1 1 1' % i for i in range(2, 10_000)),
        ),
        ('.txt', b'x,y,z,radius,parent_id\n' + b'0,0,0,1,-1, ' * 50_000),
        ('.mtg', b'CODE:\tFORM-A\nSYMBOL\tSCALE\nP\t1\nENTITY-CODE\t\tXX\n' + b'/P1' * 100_000),
    ],
    ids=['brackets', 'dashes', 'segments', 'digits', 'chain', 'star', 'line', 'code'],
)
def test_large_and_nasty(tmp_path, suffix, content):
    check(tmp_path / f'file{suffix}', 'tree', content, None)


def nasty_mtg(n: int) -> bytes:
    """Make a chain of vertices without diameters, and mostly without positions."""
    head = 'CODE:\tFORM-A\nSYMBOL\tSCALE\nP\t1\nS\t2\n'
    head += 'ENTITY-CODE\t\tXX\tYY\tZZ\n/P1\n\t/S1\t0\t0\t0\n'
    chain = ''.join(f'\t^<S{i}\n' for i in range(n))
    return (head + chain + '\t^<S9\t0\t0\t1\n').encode()


def nasty_swc(n: int) -> bytes:
    """Make a chain of points at one place, each with a side branch."""
    rows = ['1 1 0 0 0 1 -1', '2 1 0 0 1 1 1']
    rows += [f'{2 * i + 1} 1 0 0 1 .9 {2 * i - 1 if i > 1 else 2}' for i in range(1, n)]
    rows += [f'{2 * i + 2} 1 1 0 1 .1 {2 * i + 1}' for i in range(1, n)]
    return '\n'.join(rows).encode()


@pytest.mark.parametrize(('suffix', 'content'),
                         [('.mtg', nasty_mtg(20_000)), ('.swc', nasty_swc(5_000))],
                         ids=['mtg', 'swc'])  # fmt: skip
def test_long_ways_back_are_not_walked_again_and_again(tmp_path, suffix, content):
    check(tmp_path / f'file{suffix}', 'tree', content, None)


def test_ten_thousand_columns_are_enough(tmp_path):
    content = b'time,u,v' + b',x' * 10_000 + b'\n0,1,2'
    (tmp_path / 'a.csv').write_bytes(content)
    with pytest.raises(TreeSwayError, match='a header of 10003 columns'):
        read_wind(tmp_path / 'a.csv')


@pytest.mark.parametrize('reader', ['scene', 'trees'])
@pytest.mark.parametrize(
    'content',
    [b'', b'\xff\xfe', b',', b',,\n1,2,3',
     b'height,crown_radius, x,y,z,radius,parent_id,\n2.3,1.2, 1,2,5,0.1,-1, 1,2,6,0.1,1,',
     b'1 1 0 0 0 1 -1\n2 1 0 0 1 1 2\n'],
    ids=['nothing', 'a mark', 'a comma', 'commas', 'its own parent', 'its own parent, swc'],
)  # fmt: skip
def test_files_of_almost_nothing_are_refused(tmp_path: Path, content: bytes, reader: str) -> None:
    suffix = '.swc' if content.startswith(b'1 1') else '.csv'
    path = tmp_path / f'a{suffix}'
    path.write_bytes(content)
    assert fault_of(READERS[reader], path) == ('', True)
