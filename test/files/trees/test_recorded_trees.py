# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Large trees in every format: what comes in equals the files' own sums.

Those of our own making are written here from a tree of 121 branches. Scans by others, whose
licences keep them out of this repository, are read too where they lie beside it.

"""

from pathlib import Path
import re

import numpy as np
import pytest
from scipy.io import loadmat, savemat

from tree_sway.core.settings import Settings
from tree_sway.core.setup.reductions import TreeReductions
from tree_sway.files.export.tree_export import write_tree
from tree_sway.files.trees.tree_file import read_tree

pytestmark = pytest.mark.usefixtures('readers_in_this_process')

TREES = Path(__file__).parents[4] / 'shared/data/trees'
OURS = Path(__file__).parents[1] / 'data' / 'tree121.csv'


def table(path, skip=1):
    return np.loadtxt(path, delimiter=',', skiprows=skip)


def rows_of_ours():
    """Columns of the tree of 121 branches: as in the file, a mean radius, and the continuation."""
    data = table(OURS)
    parent, branch = data[:, 1].astype(int), data[:, 2].astype(int)
    after = np.full(len(data), -1)
    has_predecessor = (parent >= 0) & (branch == branch[parent])
    after[parent[has_predecessor]] = np.flatnonzero(has_predecessor)
    axis = data[:, 6:9] - data[:, 3:6]
    return data, parent, branch, after, (data[:, 9] + data[:, 10]) / 4, axis


def write_archi(path):
    data, parent, branch, after, radius, axis = rows_of_ours()
    length = np.linalg.norm(axis, axis=1)
    volume = np.pi * radius**2 * length
    columns = [
        data[:, 3:9],
        data[:, 0] + 1,
        parent + 1,
        after + 1,
        radius,
        length,
        volume,
        branch + 1,
    ]
    head = 'startX,startY,startZ,endX,endY,endZ,cyl_ID,parent_ID,extension_ID,radius_cyl,length,'
    np.savetxt(path, np.column_stack(columns), delimiter=',', comments='', fmt='%.12g',
               header=f'{head}volume,axis_ID')  # fmt: skip


def write_simpleforest(path):
    data, parent, branch, _, radius, axis = rows_of_ours()
    order = np.zeros(len(data), dtype=int)
    growth = np.linalg.norm(axis, axis=1)
    for row in range(1, len(data)):
        order[row] = order[parent[row]] + (branch[row] != branch[parent[row]])
    for row in range(len(data) - 1, 0, -1):
        growth[parent[row]] += growth[row]
    zero = np.zeros(len(data))
    columns = [data[:, 0], parent, data[:, 3:9], radius, zero, growth, zero, zero, zero, order]
    head = 'ID,parentID,startX,startY,startZ,endX,endY,endZ,radius,length,growthLength,'
    np.savetxt(
        path,
        np.column_stack(columns),
        delimiter=',',
        comments='',
        fmt='%.12g',
        header=f'{head}averagePointDistance,segmentID,parentSegmentID,branchOrder',
    )


def treeqsm_columns():
    data, parent, branch, after, radius, axis = rows_of_ours()
    length = np.linalg.norm(axis, axis=1)
    return {'radius': radius, 'length': length, 'start': data[:, 3:6],
            'axis': axis / length[:, None], 'parent': parent + 1, 'extension': after + 1,
            'added': 0 * branch, 'UnmodRadius': radius, 'branch': branch + 1}  # fmt: skip


def write_treeqsm_text(path):
    columns = [*treeqsm_columns().values(), np.zeros((len(table(OURS)), 2))]
    np.savetxt(path, np.column_stack(columns), delimiter='\t', fmt='%.12g')


def write_treeqsm_mat(path):
    columns = treeqsm_columns()
    litres = 1000 * (np.pi * columns['radius'] ** 2 * columns['length']).sum()
    savemat(path, {'QSM': {'cylinder': columns, 'treedata': {'TotalVolume': litres}}})


def copy_of_ours(path):
    path.write_bytes(OURS.read_bytes())


WRITERS = {
    'our.simpleforest.csv': write_simpleforest, 'our.archi.csv': write_archi,
    'our.treeqsm.txt': write_treeqsm_text, 'our.mat': write_treeqsm_mat, 'our.csv': copy_of_ours,
}  # fmt: skip


@pytest.fixture(scope='module')
def file_of(tmp_path_factory):
    """Path of a file by its name: one of ours, or one that others recorded."""
    folder = tmp_path_factory.mktemp('trees')
    for name, write in WRITERS.items():
        write(folder / name)
    return lambda name: (folder if name in WRITERS else TREES) / name


def here(*cases):
    """Those of the cases whose file is one of ours or lies beside the repository."""
    names = [case if isinstance(case, str) else case[0] for case in cases]
    return [c for c, n in zip(cases, names, strict=True) if n in WRITERS or (TREES / n).exists()]


def sums_of_simpleforest(path):
    data = table(path)
    length = np.linalg.norm(data[:, 5:8] - data[:, 2:5], axis=1)
    order, parent = data[1:, 14], data[1:, 1].astype(int)
    branches = 1 + np.count_nonzero(order != data[parent, 14])
    height = data[:, [4, 7]].max() - data[0, 4]
    return len(data), branches, height, (np.pi * data[:, 8] ** 2 * length).sum()


def sums_of_archi(path):
    data = table(path)
    height = data[:, [2, 5]].max() - data[0, 2]
    return len(data), len(set(data[:, 12])), height, data[:, 11].sum()


def sums_of_treeqsm(radius, length, start, axis, branch):
    ends = start + length[:, None] * axis
    height = max(start[:, 2].max(), ends[:, 2].max()) - start[0, 2]
    return len(radius), len(np.unique(branch)), height, (np.pi * radius**2 * length).sum()


def sums_of_treeqsm_text(path):
    data = np.loadtxt(path)
    return sums_of_treeqsm(data[:, 0], data[:, 1], data[:, 2:5], data[:, 5:8], data[:, 12])


def sums_of_treeqsm_mat(path):
    content = loadmat(path, squeeze_me=True, struct_as_record=False)
    (qsm,) = (value for key, value in content.items() if not key.startswith('__'))
    names = ('radius', 'length', 'start', 'axis', 'branch')
    columns = [np.asarray(getattr(qsm.cylinder, name), dtype=float) for name in names]
    sums = sums_of_treeqsm(*columns)
    # What TreeQSM says itself, in litres and in single precision.
    assert sums[3] == pytest.approx(qsm.treedata.TotalVolume / 1000, rel=1e-6)
    return sums


def sums_of_tree121(path):
    data = table(path)
    d0, d1 = data[:, 9], data[:, 10]
    length = np.linalg.norm(data[:, 6:9] - data[:, 3:6], axis=1)
    volume = (np.pi / 12 * length * (d0**2 + d0 * d1 + d1**2)).sum()
    return len(data), len(set(data[:, 2])), data[:, [5, 8]].max() - data[0, 5], volume


@pytest.mark.parametrize(
    ('name', 'sums'),
    here(
        ('our.simpleforest.csv', sums_of_simpleforest),
        ('our.archi.csv', sums_of_archi),
        ('our.treeqsm.txt', sums_of_treeqsm_text),
        ('our.mat', sums_of_treeqsm_mat),
        ('our.csv', sums_of_tree121),
        ('qsm_simpleforest.csv', sums_of_simpleforest),
        ('qsm_archi.csv', sums_of_archi),
        ('qsm_treeqsm_2.3.txt', sums_of_treeqsm_text),
        ('qsm_treeqsm_v5.mat', sums_of_treeqsm_mat),
        ('qsm_treeqsm_struct.mat', sums_of_treeqsm_mat),
    ),
)
def test_equal_to_the_files_own_sums(file_of, name, sums):
    tree = read_tree(file_of(name), twig_diameter=0.0, thicken=False).tree
    segments, branches, height, volume = sums(file_of(name))
    assert (tree.n_segments, tree.n_branches) == (segments, branches)
    assert tree.height == pytest.approx(height, rel=1e-6)
    assert tree.volume.sum() == pytest.approx(volume, rel=1e-6)


def test_from_mean_radii_it_is_nearly_the_same(file_of):
    one = read_tree(file_of('our.csv')).tree
    for name in set(WRITERS) - {'our.csv'}:
        other = read_tree(file_of(name)).tree
        np.testing.assert_allclose(other.end, one.end, atol=1e-6)
        np.testing.assert_array_equal(other.branch_parent, one.branch_parent)


@pytest.mark.parametrize('name', here('our.mat', 'our.csv', 'walnut.mtg', 'qsm_treeqsm_v5.mat'))
def test_written_and_read_again(tmp_path, file_of, name):
    first = read_tree(file_of(name)).tree
    write_tree(tmp_path / 'again.yaml', first)
    again = read_tree(tmp_path / 'again.yaml').tree
    for key, value in vars(first).items():
        if key != 'source_index':
            np.testing.assert_array_equal(getattr(again, key), value, err_msg=key)


class TestScansByOthers:
    """Where they lie beside the repository."""

    __test__ = TREES.exists()

    def test_walnut(self):
        """8301 vertices with a position, one root, 7.95 m."""
        tree_file = read_tree(TREES / 'walnut.mtg')
        tree = tree_file.tree
        lines = (TREES / 'walnut.mtg').read_text().splitlines()
        begin = next(i for i, line in enumerate(lines) if line.startswith('ENTITY-CODE'))
        cells = [line.split('\t') for line in lines[begin + 1 :] if line.strip()]
        z = np.array([float(row[17]) for row in cells if len(row) > 17 and row[17].strip()])
        assert len(z) == 8301
        assert tree_file.notes[0].startswith('8301 vertices with a position')
        assert tree.height == pytest.approx((z.max() - z[0]) / 100, rel=1e-6)
        assert tree.height == pytest.approx(7.95, abs=0.01)
        assert np.count_nonzero(tree.segment_parent < 0) == 1
        # Every vertex of the finest scale with a position is a segment, or was merged.
        merged = int(re.match(r'\d+', tree_file.notes[1])[0])
        fine = [
            row
            for row in cells
            if re.search(r'[SU]\d+', ''.join(row[:10])) and ''.join(row[15:18])
        ]
        assert tree.n_segments + merged == len(fine)
        assert tree.base_diameter[0] == pytest.approx(0.270)

    @pytest.mark.long
    def test_the_walnut_sways_as_walnuts_do(self):
        """f1 within 1.2 to 1.9 Hz, 20 modes or more below 2.9 Hz, with the table's walnut."""
        tree_file = read_tree(TREES / 'walnut.mtg', species='walnut')
        settings = Settings(model=20)
        slowest = TreeReductions(tree_file.tree, tree_file.species, settings).natural_frequencies(
            20
        )
        assert 1.2 <= slowest[0] <= 1.9
        assert len(slowest) == 20
        assert slowest[-1] < 2.9

    def test_world_coordinates_are_moved_and_reported(self):
        tree_file = read_tree(TREES / 'qsm_archi.csv')
        np.testing.assert_array_equal(tree_file.tree.start[0], 0.0)
        assert tree_file.origin[2] == pytest.approx(253.948, abs=1e-3)
        assert any(note.startswith('moved by') for note in tree_file.notes)
