# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A file that describes a tree is opened as it states it; a fit of a scan may be mended, aloud."""

from __future__ import annotations

import json
import warnings

import numpy as np
import pytest
import yaml

from tree_sway.core.settings import Settings
from tree_sway.core.setup.preparation import prepare
from tree_sway.core.species.foliage_traits import LeafTraits
from tree_sway.core.species.species import Species
from tree_sway.core.tree.building import tree_from_segments
from tree_sway.errors import TreeError
from tree_sway.files.export.yaml_writing import yaml_of_tree
from tree_sway.files.models.model_writer import write_model
from tree_sway.files.trees.source import open_scene, open_tree
from tree_sway.files.trees.tree_file import TREE_FORMATS
from tree_sway.files.trees.tree_options import FITTED

BASE = np.array([3.0, 4.0, 0.5])


def limp_tree(seed):
    """Make a tree off the origin, far too slender to stand, of which no diameter is round."""
    rng = np.random.default_rng(seed)
    nodes, diameter, above = [BASE], [0.02], [-1]
    for row in range(1, 40):
        parent = int(rng.integers(max(1, row - 6), row)) if row > 1 else 0
        up = np.array([0.0, 0.0, 0.4]) + rng.normal(0.0, 0.2, 3)
        nodes.append(nodes[parent] + up)
        diameter.append(float(diameter[parent] * rng.uniform(0.7, 0.99)))
        above.append(parent)
    return np.array(nodes), np.array(diameter), np.array(above)


def stated(nodes, diameter, above):
    """Rows of start, end and both diameters of every segment, in an order of their own."""
    rows = [
        [*nodes[a], *nodes[i], diameter[a], diameter[i]] for i, a in enumerate(above) if a >= 0
    ]
    return ordered(np.array(rows))


def ordered(rows):
    return rows[np.lexsort(np.round(rows, 6).T[::-1])]


def tree_of(nodes, diameter, above):
    """Make the tree of some nodes."""
    outer = np.arange(1, len(above))
    inner = above[outer]
    both = np.stack([diameter[inner], diameter[outer]], axis=1)
    return tree_from_segments(nodes[inner], nodes[outer], both, parent=inner - 1)


def csv_of(path, nodes, diameter, above):
    tree = tree_of(nodes, diameter, above)
    lines = ['segment,parent,x0,y0,z0,x1,y1,z1,d0,d1']
    for i in range(tree.n_segments):
        row = [*tree.start[i], *tree.end[i], tree.base_diameter[i], tree.tip_diameter[i]]
        lines.append(f'{i},{tree.segment_parent[i]},{",".join(f"{x:.17g}" for x in row)}')
    path.write_text('\n'.join(lines))


def yaml_text_of(path, *tree):
    path.write_text(yaml_of_tree(tree_of(*tree)))


def json_of(path, *tree):
    path.write_text(json.dumps(yaml.safe_load(yaml_of_tree(tree_of(*tree)))))


def swc_of(path, nodes, diameter, above):
    rows = zip(nodes, diameter, above, strict=True)
    lines = [
        f'{i + 1} 1 {" ".join(f"{x:.17g}" for x in (*node, 0.5 * d))} {a + 1 if a >= 0 else -1}'
        for i, (node, d, a) in enumerate(rows)
    ]
    path.write_text('\n'.join(lines))


def mtg_of(path, nodes, diameter, above):
    """Write each node as a vertex in the column of its depth, in cm and mm."""
    columns = 45
    head = ['CODE:\tFORM-A', '', 'CLASSES:',
            'SYMBOL\tSCALE\tDECOMPOSITION\tINDEXATION\tDEFINITION',
            '$\t0\tFREE\tFREE\tIMPLICIT', 'P\t1\tCONNECTED\tFREE\tEXPLICIT',
            'S\t2\tNONE\tFREE\tIMPLICIT', '', 'MTG:', '',
            'ENTITY-CODE' + '\t' * columns + 'XX\tYY\tZZ\tTopDia']  # fmt: skip

    def line(code, depth, row):
        numbers = '\t'.join(f'{x:.17g}' for x in (*(100.0 * nodes[row]), 1e3 * diameter[row]))
        return '\t' * depth + code + '\t' * (columns - depth) + numbers

    lines = [line('/P1/S1', 0, 0)]

    def add(row, depth):
        for child in np.flatnonzero(above == row).tolist():
            lines.append(line(f'+S{child + 1}', depth, child))
            add(child, depth + 1)

    add(0, 1)
    path.write_text('\n'.join([*head, *lines]))


def npz_of(path, *tree):
    write_model(path, prepare(tree_of(*tree), settings=Settings(model=6, gravity=0.0)))


WRITERS = {
    'csv': csv_of, 'json': json_of, 'yaml': yaml_text_of, 'swc': swc_of, 'mtg': mtg_of,
    'npz': npz_of,
}  # fmt: skip


def test_every_format_of_descriptions_is_tried():
    described = {each.name for each in TREE_FORMATS if each.defaults != FITTED}
    assert described == WRITERS.keys() - {'json'}


@pytest.mark.parametrize('seed', range(3))
@pytest.mark.parametrize('suffix', WRITERS)
@pytest.mark.parametrize('in_leaf', [True, False])
def test_a_description_is_opened_as_it_states_its_segments(tmp_path, suffix, seed, in_leaf):
    path = tmp_path / f'limp.{suffix}'
    nodes = limp_tree(seed)
    WRITERS[suffix](path, *nodes)
    with warnings.catch_warnings():
        warnings.simplefilter('error')
        opened = open_tree(path, in_leaf=in_leaf)
    tree = opened.tree
    rows = np.column_stack([tree.start, tree.end, tree.base_diameter, tree.tip_diameter])
    np.testing.assert_allclose(ordered(rows), stated(*nodes), rtol=0.0, atol=1e-9)
    assert opened.origin == (0.0, 0.0, 0.0)
    assert not any('thickened' in each for each in opened.warnings)


def pole_rows(length, diameter):
    """Rows of SimpleForest for a pole in twelve pieces."""
    piece = length / 12
    head = 'ID,parentID,startX,startY,startZ,endX,endY,endZ,radius,branchOrder,growthLength'
    rows = [
        f'{i},{i - 1},0,0,{i * piece},0,0,{(i + 1) * piece},{0.5 * diameter},0,{12 - i}'
        for i in range(12)
    ]
    return '\n'.join([head, *rows])


def test_a_scan_that_cannot_stand_is_mended_with_a_python_warning_that_counts(tmp_path):
    path = tmp_path / 'pole.csv'
    path.write_text(pole_rows(20.0, 0.06))
    for opening in (open_tree, open_scene):
        with pytest.warns(UserWarning, match=r' of 12 segments of 1 limb thickened, .* % of wood'):
            opened = opening(path)
        assert 'segments of 1 limb thickened' in opened.warnings[0]
        assert 'thicken=no leaves it' in opened.warnings[0]
    assert (open_tree(path, thicken=False).tree.base_diameter == 0.06).all()


def test_a_scan_that_stands_bare_is_changed_for_a_summer_alone(tmp_path):
    path = tmp_path / 'pole.csv'
    path.write_text(pole_rows(5.2, 0.02))
    leaves = LeafTraits(size=0.5, area_per_section=3000.0, fresh_mass=1.0)
    leafy = Species('w', 'wood', modulus=9e9, density=900.0, leaves=leaves)

    def opened(in_leaf):
        return open_tree(path, wood=lambda _: leafy, in_leaf=in_leaf, twig_diameter=0.0).tree

    with warnings.catch_warnings():
        warnings.simplefilter('error')
        assert (opened(None).base_diameter == 0.02).all()
        assert (opened(False).base_diameter == 0.02).all()
    with pytest.warns(UserWarning, match='changed, as in leaf it could carry'):
        assert (opened(True).base_diameter > 0.02).any()


def test_a_description_that_cannot_stand_is_refused_with_the_change_to_ask_for(tmp_path):
    path = tmp_path / 'limp.csv'
    csv_of(path, *limp_tree(0))
    opened = open_tree(path)
    with pytest.raises(TreeError, match='buckles under its own weight') as refused:
        prepare(opened.tree, opened.species, settings=Settings())
    assert '--option thicken=yes' in str(refused.value.cure)
    with pytest.warns(UserWarning, match='thickened'):
        asked = open_tree(path, thicken=True)
    prepare(asked.tree, asked.species, settings=Settings())
