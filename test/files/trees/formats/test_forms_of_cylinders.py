# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Forms of cylinders and skeletons that other programs write, and files that are no tree."""

from __future__ import annotations

import json
from pathlib import Path
import struct

import numpy as np
import pytest
from scipy.io import savemat

from tree_sway.errors import FormatError
from tree_sway.files.trees.source import open_tree

ENDS = [((0, 0, k), (0, 0, k + 1), 0.1 - 0.01 * k) for k in range(6)]
ENDS += [((0, 0, 3), (1, 0, 3.5), 0.02), ((1, 0, 3.5), (2, 0, 4), 0.01)]


def flat(*cells: object) -> str:
    return ','.join(map(str, cells))


def test_ends_and_a_radius_are_joined_where_they_meet(tmp_path):
    path = tmp_path / 'ends.csv'
    lines = [flat(*begin, *end, radius) for begin, end, radius in ENDS]
    path.write_text('\n'.join(['x1,y1,z1,x2,y2,z2,radius', *lines]), encoding='utf-8')
    opened = open_tree(path)
    assert (opened.tree.n_segments, opened.tree.n_branches) == (8, 2)
    assert opened.tree.base_diameter[0] == pytest.approx(0.2)
    assert any('parents are found' in note for note in opened.notes)


def test_without_growth_lengths_the_thickest_child_continues(tmp_path):
    path = tmp_path / 'cylinders.csv'
    parents = [-1, 0, 1, 2, 3, 4, 2, 6]
    names = 'ID,parentID,startX,startY,startZ,endX,endY,endZ,radius,branchOrder'
    lines = [
        flat(number, parent, *begin, *end, radius, 0)
        for number, (parent, (begin, end, radius)) in enumerate(zip(parents, ENDS, strict=True))
    ]
    path.write_text('\n'.join([names, *lines]), encoding='utf-8')
    tree = open_tree(path).tree
    assert (tree.n_segments, tree.n_branches) == (8, 2)
    assert tree.segments_of(0).stop - tree.segments_of(0).start == 6


def test_points_are_no_tree(tmp_path):
    path = tmp_path / 'points.txt'
    path.write_text('0.1 0.2 3.4\n' * 20, encoding='utf-8')
    with pytest.raises(FormatError, match='a point cloud'):
        open_tree(path)


DATA = Path(__file__).parents[2] / 'data'
PARENT = [-1, 0, 1, 2, 3, 4, 2, 6]


def is_ends(path: Path, notes: str = '') -> None:
    """Check that a file is read as the tree of `ENDS`."""
    opened = open_tree(path, twig_diameter=0.0, thicken=False)
    tree = opened.tree
    assert (tree.n_segments, tree.n_branches) == (8, 2)
    assert tree.height == pytest.approx(6.0)
    assert tree.base_diameter[0] == pytest.approx(0.2)
    tips = {tuple(np.round(tree.end[tree.segments_of(branch).stop - 1], 6)) for branch in (0, 1)}
    assert tips == {(0, 0, 6), (2, 0, 4)}
    assert notes in ' '.join(opened.notes)


def rows_of(columns: str) -> list[str]:
    """Rows of the cylinders of `ENDS`, with columns as expressions of their numbers."""
    rows = []
    for row, (begin, end, radius) in enumerate(ENDS):
        a, b = np.array(begin, float), np.array(end, float)
        length = np.linalg.norm(b - a)
        cells = {'id': row + 1, 'up': PARENT[row] + 1, 'a': a, 'b': b, 'r': radius, 'l': length,
                 'x': (b - a) / length, 'branch': 1 if row < 6 else 2}  # fmt: skip
        values = [cells[name] for name in columns.split()]
        rows.append(','.join(','.join(map(str, np.ravel(value))) for value in values))
    return rows


@pytest.mark.parametrize(
    ('header', 'columns'),
    [
        (  # of TreeQSM's models, as rTwig orders them: row numbers stand for the extension
            'length,start.x,start.y,start.z,axis.x,axis.y,axis.z,radius,UnmodRadius,branch,parent,'
            'extension',
            'l a x r r branch up id',
        ),
        (
            'id,parent,start_x,start_y,start_z,axis_x,axis_y,axis_z,end_x,end_y,end_z,radius,'
            'raw_radius,length,branch,branch_order',
            'id up a x b r r l branch branch',
        ),
        (  # of SimpleForest's models: numbered from 1
            'ID,parentID,startX,startY,startZ,endX,endY,endZ,axisX,axisY,axisZ,radius,UnmodRadius,'
            'length,branchOrder,branchID',
            'id up a b x r r l branch branch',
        ),
    ],
    ids=['treeqsm', 'standard', 'simpleforest'],
)
def test_tables_of_rtwig_are_read_by_their_names(tmp_path, header, columns):
    path = tmp_path / 'tree.csv'
    path.write_text('\n'.join([header, *rows_of(columns)]), encoding='utf-8')
    is_ends(path)


def test_a_header_of_other_columns_is_not_read_by_position(tmp_path):
    """Thirteen columns are those of TreeQSM, unless that the header names them elsewhere."""
    path = tmp_path / 'tree.csv'
    header = 'length,x0,y0,z0,x1,y1,z1,radius,raw,branch,parent,extension,more'
    path.write_text('\n'.join([header, *rows_of('l a x r r branch up id branch')]))
    with pytest.raises(FormatError, match='unknown tree format'):
        open_tree(path)


def treegraph_columns() -> dict[str, dict[str, float | None]]:
    """Columns as pandas writes them, for the cylinders of `ENDS`, which go towards the base."""
    columns: dict[str, dict[str, float | None]] = {}
    for row, (begin, end, radius) in enumerate(ENDS):
        way = np.subtract(begin, end)
        length = float(np.linalg.norm(way))
        values = {'p1': row + 7, 'p2': PARENT[row] + 7, 'radius': radius, 'length': length}
        values |= dict(zip(('sx', 'sy', 'sz'), map(float, end), strict=True))
        values |= dict(zip(('ax', 'ay', 'az'), map(float, way / length), strict=True))
        for name, value in values.items():
            columns.setdefault(name, {})[str(3 * row)] = value
    return columns


@pytest.mark.parametrize('is_text', [True, False])
def test_treegraph(tmp_path, is_text):
    path = tmp_path / 'tree.json'
    columns = treegraph_columns()
    document = {
        'name': 'T1',
        'created': '2026',
        'cyls': json.dumps(columns) if is_text else columns,
    }
    path.write_text(json.dumps(document, indent=None if is_text else 1), encoding='utf-8')
    is_ends(path, 'lowest node')
    columns['radius']['3'] = None
    path.write_text(json.dumps(document | {'cyls': columns}), encoding='utf-8')
    with pytest.raises(FormatError, match="cylinder 1: no number in 'radius'"):
        open_tree(path)
    columns['radius']['3'] = 0.1
    columns['p1']['21'], columns['p2']['21'] = 7, 12  # between nodes that are joined already
    path.write_text(json.dumps(document | {'cyls': columns}), encoding='utf-8')
    with pytest.raises(FormatError, match='a ring'):
        open_tree(path)


def test_the_table_of_treegraph(tmp_path):
    path = tmp_path / 'cyls.csv'
    columns = treegraph_columns()
    rows = [','.join(str(each[row]) for each in columns.values()) for row in columns['p1']]
    path.write_text('\n'.join([','.join(columns), *rows]), encoding='utf-8')
    is_ends(path)


@pytest.mark.parametrize(
    ('text', 'said'),
    [
        ('[{"start": [0, 0, 0], "end": [0, 0, 1], "radius": 0.1}]', 'JSON of a list'),
        ('{"name": "x", "version": "1.0"}', "JSON of keys 'name', 'version', which is no tree"),
        ('{"created": "2026", "cyls": "{', 'not JSON'),
        ('{"created": "2026", "cyls": {"p1": {"0": 1}}}', "no column 'p2'"),
    ],
)
def test_json_that_is_no_tree_is_named(tmp_path, text, said):
    path = tmp_path / 'a.json'
    path.write_text(text, encoding='utf-8')
    with pytest.raises(FormatError, match=said) as error:
        open_tree(path)
    assert error.value.cure


HEAD = 'ply\nformat {} 1.0\ncomment a\nelement vertex 9\n'
HEAD += ''.join(f'property float {name}\n' for name in ('x', 'y', 'z', 'radius'))
PAIR = 'element edge 8\nproperty int vertex1\nproperty int vertex2\nend_header\n'
LIST = 'element edge 8\nproperty list uchar int vertex_indices\nend_header\n'
NODES = [(0.0, 0.0, 0.0, 0.1), *((*map(float, end), radius) for _, end, radius in ENDS)]


def skeleton(order: str, *, is_list: bool) -> bytes:
    head = HEAD.format(order) + (LIST if is_list else PAIR)
    edges = [(2, up + 1, row + 1)[not is_list :] for row, up in enumerate(PARENT)]
    if order == 'ascii':
        return (head + '\n'.join(' '.join(map(str, row)) for row in [*NODES, *edges])).encode()
    mark = '<' if 'little' in order else '>'
    edge = mark + ('Bii' if is_list else 'ii')
    body = b''.join(struct.pack(f'{mark}4f', *row) for row in NODES)
    return head.encode() + body + b''.join(struct.pack(edge, *row) for row in edges)


@pytest.mark.parametrize('order', ['ascii', 'binary_little_endian', 'binary_big_endian'])
@pytest.mark.parametrize('is_list', [True, False])
def test_a_skeleton_of_vertices_and_edges(tmp_path, order, is_list):
    path = tmp_path / 'skeleton.ply'
    path.write_bytes(skeleton(order, is_list=is_list))
    is_ends(path, 'lowest node')
    path.write_bytes(path.read_bytes()[:-10])
    with pytest.raises(FormatError, match='other vertices or edges than its header says'):
        open_tree(path)


@pytest.mark.parametrize(
    ('old', 'new', 'said'),
    [
        ('property float radius\n', 'property float confidence\n', 'a skeleton without radii'),
        ('edge 8', 'edge 0', 'a point cloud, not a tree; fit cylinders'),
        ('element edge', 'element face 3\nelement edge', 'a mesh for drawing'),
        ('list uchar int vertex_indices', 'int vertex1', 'edges without two vertices'),
        ('vertex 9', 'vertex 0', 'without vertices'),
        ('vertex 9', 'vertex nine', 'damaged header'),
        ('2 7 8', '2 7 99', 'edge 8 joins 7 and 99 of 9 nodes'),
        ('2 7 8', '2 1 5', 'a ring'),
        ('0.0 0.0 1.0 0.1', '0.0 0.0 nan 0.1', 'vertex 1: a place or a radius that is no number'),
    ],
)
def test_ply_that_is_no_skeleton_is_named(tmp_path, old, new, said):
    path = tmp_path / 'a.ply'
    text = skeleton('ascii', is_list=True).decode()
    assert old in text
    path.write_text(text.replace(old, new), encoding='utf-8')
    with pytest.raises(FormatError, match=said) as error:
        open_tree(path)
    assert error.value.cure


def test_parts_beside_the_tree_are_left_out_and_counted(tmp_path):
    path = tmp_path / 'a.ply'
    text = skeleton('ascii', is_list=True).decode().replace('vertex 9', 'vertex 11')
    path.write_text(text.replace('\n2 0 1', '\n5 5 5 1\n6 6 6 1\n2 0 1'), encoding='utf-8')
    is_ends(path, '2 nodes hang on other parts and are left out')


def test_a_model_without_extensions_is_read(tmp_path):
    axis = [np.subtract(end, begin) for begin, end, _ in ENDS]
    length = np.linalg.norm(axis, axis=1)
    cylinder = {'radius': [each[2] for each in ENDS], 'length': length,
                'start': np.array([each[0] for each in ENDS], float),
                'axis': axis / length[:, None], 'parent': np.add(PARENT, 1)}  # fmt: skip
    savemat(tmp_path / 'a.mat', {'QSM': {'cylinder': cylinder}})
    is_ends(tmp_path / 'a.mat')


@pytest.mark.parametrize('name', ['fork.ply', 'fork.treegraph.json'])
def test_a_skeleton_of_the_samples(name):
    opened = open_tree(DATA / name, twig_diameter=0.0)
    assert (opened.tree.n_segments, opened.tree.n_branches) == (5, 2)
