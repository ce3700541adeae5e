# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The same small tree in every format; files list the side branch before the stem's end."""

from pathlib import Path

import numpy as np
import pytest
from scipy.io import savemat

from tree_sway.errors import FormatError, TreeError, TreeSwayError
from tree_sway.files.trees.formats.treeqsm import read_treeqsm_text
from tree_sway.files.trees.tree_file import read_tree, read_trees

pytestmark = pytest.mark.usefixtures('readers_in_this_process')

DATA = Path(__file__).parents[2] / 'data'
CYLINDER_FILES = ['fork.simpleforest.csv', 'fork.archi.csv', 'fork.treeqsm23.txt',
                  'fork.treeqsm24.txt', 'fork.pytlidar.txt']  # fmt: skip
AS_SCANNED = {'twig_diameter': 0.0}
OFFSET = (100.0, 200.0, 50.0)
VOLUME = np.pi * (0.10**2 + 0.08**2 + 0.03**2 + 0.02**2)


def assert_is_the_fork(tree_file, volume=VOLUME):
    tree = tree_file.tree
    assert (tree.n_segments, tree.n_branches) == (4, 2)
    assert list(tree.branch_parent) == [-1, 0]
    assert list(tree.segment_parent) == [-1, 0, 0, 2]
    np.testing.assert_allclose(tree.end[1], [0, 0, 2], atol=1e-9)
    np.testing.assert_allclose(tree.start[2], [0, 0, 0.7], atol=1e-9)
    np.testing.assert_allclose(tree.end[3], [1.2, 0, 2.3], atol=1e-6)
    assert tree.height == pytest.approx(2.3, abs=1e-6)
    assert tree.volume.sum() == pytest.approx(volume, rel=1e-6)
    np.testing.assert_allclose(tree_file.origin, OFFSET)


@pytest.mark.parametrize('name', CYLINDER_FILES)
def test_the_same_tree_from_each(name):
    assert_is_the_fork(read_tree(DATA / name, **AS_SCANNED))


@pytest.mark.parametrize('name', CYLINDER_FILES)
def test_its_place_is_reported_or_kept(name):
    moved = read_tree(DATA / name, **AS_SCANNED)
    assert 'moved by -100, -200, -50 m, the base to the origin' in moved.notes
    kept = read_tree(DATA / name, to_origin=False, **AS_SCANNED)
    np.testing.assert_allclose(kept.tree.start[0], OFFSET)
    assert kept.notes == ()


def columns_of_fork(base=1):
    (cylinders,) = read_treeqsm_text(DATA / 'fork.treeqsm24.txt')
    axis = cylinders.end - cylinders.start
    length = np.linalg.norm(axis, axis=1)
    parent = np.array([0, 1, 1, 2]) + base - 1
    extension = np.array([3, 4, 0, 0]) + base - 1
    return {
        'radius': cylinders.diameter[:, 0] / 2, 'length': length, 'start': cylinders.start,
        'axis': axis / length[:, None], 'parent': parent, 'extension': extension,
    }  # fmt: skip


@pytest.mark.parametrize('compressed', [False, True])
def test_matlab_structs(tmp_path, compressed):
    path = tmp_path / 'fork.mat'
    savemat(path, {'QSM': {'cylinder': columns_of_fork(), 'x': 1}}, do_compression=compressed)
    assert_is_the_fork(read_tree(path, **AS_SCANNED))


def test_matlab_arrays_of_structs(tmp_path):
    cells = np.array([{'cylinder': columns_of_fork()}, {'cylinder': columns_of_fork()}])
    structs = np.array([(columns_of_fork(),), (columns_of_fork(),)], dtype=[('cylinder', object)])
    for models in (cells, structs):
        savemat(tmp_path / 'two.mat', {'models': models})
        for tree_file in read_trees(tmp_path / 'two.mat', **AS_SCANNED):
            assert_is_the_fork(tree_file)
        assert read_tree(tmp_path / 'two.mat').notes[-1] == 'the file has 1 more trees'


def test_models_of_one_tree_are_named(tmp_path):
    here = columns_of_fork()
    beside = columns_of_fork()
    beside['start'] = beside['start'] + [[0.5, 0.0, 0.0]]
    savemat(tmp_path / 'models.mat', {'a': {'cylinder': here}, 'b': {'cylinder': here}})
    first, second = read_trees(tmp_path / 'models.mat', **AS_SCANNED)
    assert '1 more of the 2 trees stand in the stem of this one' in first.faults[0]
    assert 'tree=1' in first.faults[0]
    assert second.faults == ()
    savemat(tmp_path / 'stand.mat', {'a': {'cylinder': here}, 'b': {'cylinder': beside}})
    for alone in (
        read_trees(tmp_path / 'stand.mat', **AS_SCANNED)[0],
        read_tree(tmp_path / 'models.mat', tree=1, **AS_SCANNED),
    ):
        assert alone.faults == ()


@pytest.mark.parametrize('n_columns', [9, 10, 12, 14, 15])
@pytest.mark.parametrize('base', [0, 1])
@pytest.mark.parametrize('name', ['CylData', 'CylData_updated', 'cyl'])
def test_arrays_of_cylinders_are_read_as_text_is(tmp_path, n_columns, base, name):
    fork = columns_of_fork(base)
    del fork['extension']
    columns = [np.reshape(each, (4, -1)) for each in fork.values()]
    extension = np.array([3, 4, 0, 0])[:, None] + base - 1
    rest = np.full((4, 5), np.nan)  # as `add_buttress_cylinder` leaves them
    table = np.hstack([*columns, extension, rest])[:, :n_columns]
    branches = np.arange(10.0).reshape(2, 5)
    savemat(tmp_path / 'array.mat', {name: np.single(table), 'BranchData': branches})
    found = read_tree(tmp_path / 'array.mat', **AS_SCANNED)
    assert found.tree.n_branches == 2
    assert found.tree.volume.sum() == pytest.approx(VOLUME, rel=1e-5)
    if n_columns <= 12:
        np.savetxt(tmp_path / 'array.txt', np.nan_to_num(table), fmt='%.9g')
        text = read_tree(tmp_path / 'array.txt', **AS_SCANNED)
        assert text.tree.volume.sum() == pytest.approx(VOLUME, rel=1e-5)


def test_averaged_cylinders_are_read_whose_axes_have_any_length(tmp_path):
    rng = np.random.default_rng(4)
    rows = np.arange(40)
    start = 0.5 * rows[:, None] * [[0.0, 0.0, 1.0]]
    axis = np.tile([0.0, 0.0, 1.0], (40, 1))
    axis[::7] *= rng.uniform(1.5, 30.0, (6, 1))
    parts = [np.full(40, 0.1), np.full(40, 0.5), start, axis, rows, (rows + 2) % 41]
    table = np.hstack([np.reshape(part, (40, -1)) for part in parts])
    savemat(tmp_path / 'averaged.mat', {'CylData_updated': np.single(table)})
    found = read_tree(tmp_path / 'averaged.mat', **AS_SCANNED)
    assert found.tree.n_branches == 1
    assert found.tree.height == pytest.approx(20.0, rel=1e-5)


def test_a_matrix_that_is_no_cylinders_is_refused(tmp_path):
    savemat(tmp_path / 'matrix.mat', {'x': np.random.default_rng(0).normal(size=(20, 12))})
    with pytest.raises(FormatError, match='no array of cylinders'):
        read_tree(tmp_path / 'matrix.mat')


def test_variables_of_treeqsm_2_0(tmp_path):
    fork = columns_of_fork()
    names = {
        'Rad': 'radius',
        'Len': 'length',
        'Sta': 'start',
        'Axe': 'axis',
        'CPar': 'parent',
        'CExt': 'extension',
    }
    variables = {name: fork[field] for name, field in names.items()}
    savemat(tmp_path / 'old.mat', {**variables, 'TreeData': np.ones(33)})
    assert_is_the_fork(read_tree(tmp_path / 'old.mat', **AS_SCANNED))


def test_matlab_7_3_is_read_by_netcdf4(tmp_path):
    netcdf = pytest.importorskip('netCDF4')
    path = tmp_path / 'new.mat'
    with netcdf.Dataset(path, 'w') as root:
        cylinder = root.createGroup('QSM').createGroup('cylinder')
        cylinder.createDimension('n', 4)
        cylinder.createDimension('one', 1)
        cylinder.createDimension('three', 3)
        for name, values in columns_of_fork().items():
            column = np.reshape(values, (4, -1))
            axes = ('three' if column.shape[1] == 3 else 'one', 'n')
            cylinder.createVariable(name, np.single, axes)[:] = column.T
        empty = root['QSM'].createVariable('triangulation', np.uint64, ())
        empty.MATLAB_empty = np.uint8(1)
    hdf5 = path.read_bytes()
    path.write_bytes(b'MATLAB 7.3 MAT-file'.ljust(512) + hdf5)
    found = read_tree(path, **AS_SCANNED)
    assert found.tree.n_branches == 2
    assert found.tree.volume.sum() == pytest.approx(VOLUME, rel=1e-5)
    path.write_bytes(b'MATLAB 7.3 MAT-file'.ljust(512) + bytes(400))
    with pytest.raises(FormatError, match=r'not a MATLAB file that can be read.* option -v7'):
        read_tree(path)


def test_matlab_without_a_model(tmp_path):
    savemat(tmp_path / 'other.mat', {'a': np.zeros(3)})
    with pytest.raises(FormatError, match="no struct with a field 'cylinder'"):
        read_tree(tmp_path / 'other.mat')
    savemat(tmp_path / 'part.mat', {'QSM': {'cylinder': {'radius': [1.0], 'length': [1.0]}}})
    with pytest.raises(FormatError, match="QSM has no numbers 'start'"):
        read_tree(tmp_path / 'part.mat')
    text = {**columns_of_fork(), 'axis': 'up'}
    savemat(tmp_path / 'text.mat', {'QSM': {'cylinder': text}})
    with pytest.raises(FormatError, match="QSM has no numbers 'axis'"):
        read_tree(tmp_path / 'text.mat')
    (tmp_path / 'cut.mat').write_bytes((tmp_path / 'text.mat').read_bytes()[:300])
    with pytest.raises(FormatError, match='not a MATLAB file that can be read'):
        read_tree(tmp_path / 'cut.mat')


@pytest.mark.parametrize(
    ('name', 'old', 'new', 'kind', 'message'),
    [
        ('fork.simpleforest.csv', '\n3,1,', '\n3,9,', TreeError,
         ':5: cylinder 3: orphan: its parent 9 is not'),
        ('fork.simpleforest.csv', '0,-1,', '0,0,', TreeError, 'cylinder 0: cyclic'),
        ('fork.simpleforest.csv', '2,0,', '1,0,', FormatError,
         ':4: cylinder 1: number 1 occurs twice'),
        ('fork.archi.csv', 'cyl_ID,parent', 'cyl_ID,parnt', FormatError,
         ":1: no column 'parent_ID'"),
        ('fork.archi.csv', '0.03', 'x', FormatError, ":3: radius_cyl is 'x', not a finite"),
        ('fork.treeqsm23.txt', '0.08', 'nan', FormatError, ":3: radius is 'nan', not a finite"),
        ('fork.treeqsm23.txt', '\t2\t0\t', '\t2.5\t0\t', FormatError,
         ':4: .* is 2.5, not a whole'),
        ('fork.treeqsm23.txt', '\t1\t0\t0\t0.08', '\t77\t0\t0\t0.08', TreeError,
         ':3: cylinder 3: orphan'),
        ('fork.treeqsm24.txt', '0.08', '-0.08', TreeError, ':4: cylinder 3: diameter'),
        ('fork.treeqsm24.txt', '100\t200\t51', '100\t200\t5e99', TreeError,
         ':4: cylinder 3: .* too large'),
        ('fork.pytlidar.txt', '\t-1.0\t2.0', '\t5.0\t2.0', TreeError, ':2: cylinder 1: orphan'),
    ],
)  # fmt: skip
def test_errors_name_the_line(tmp_path, name, old, new, kind, message):
    text = (DATA / name).read_text()
    assert old in text
    (tmp_path / name).write_text(text.replace(old, new, 1))
    with pytest.raises(TreeSwayError, match=message) as caught:
        read_tree(tmp_path / name)
    assert isinstance(caught.value, kind)


def cyl_data():
    """Make the fork as a bare matrix of 14 columns, as TreeQSM 2.0 and older saved it as text."""
    columns = columns_of_fork()
    branch, order = [1, 2, 1, 2], [0, 1, 0, 1]
    return np.column_stack([columns['radius'], columns['length'], columns['start'],
                            columns['axis'], columns['parent'], columns['extension'],
                            branch, order, [1, 1, 2, 2], np.zeros(4)])  # fmt: skip


@pytest.mark.parametrize('stretch', [1.0, 3.0])
def test_a_bare_matrix_of_cylinders(tmp_path, stretch):
    matrix = cyl_data()
    matrix[:, 5:8] *= stretch  # axes need not be of length 1
    for separator in ('\t', ' ', ',', '; '):
        rows = [separator.join(f'{value:.9g}' for value in row) for row in matrix]
        (tmp_path / 'a.txt').write_text('\n'.join(rows))
        assert_is_the_fork(read_tree(tmp_path / 'a.txt', **AS_SCANNED))
        (tmp_path / 'b.txt').write_text('\n'.join([separator.join('abcdefghijklmn'), *rows]))
        assert_is_the_fork(read_tree(tmp_path / 'b.txt', **AS_SCANNED))


def test_a_first_row_does_not_mislead(tmp_path):
    text = (DATA / 'fork.treeqsm23.txt').read_text().replace('0\t0\t1\t0\t3', '0\t0\t0.5\t0\t3', 1)
    (tmp_path / 'a.txt').write_text(text)
    assert_is_the_fork(read_tree(tmp_path / 'a.txt', **AS_SCANNED))
    (tmp_path / 'a.txt').write_text(text.replace('0\t0\t0.5\t0\t3', '0\t0\t0\t0\t3', 1))
    with pytest.raises(FormatError, match=r'a.txt:1: cylinder 1: an axis without direction'):
        read_tree(tmp_path / 'a.txt')


def test_decimal_commas_say_so(tmp_path):
    text = (DATA / 'fork.treeqsm23.txt').read_text().replace('.', ',')
    (tmp_path / 'a.txt').write_text(text)
    with pytest.raises(FormatError, match='a decimal comma; export it with decimal points'):
        read_tree(tmp_path / 'a.txt')
    with pytest.raises(FormatError, match=":1: radius is '0,1', with a decimal comma"):
        read_tree(tmp_path / 'a.txt', format='treeqsm-text')
