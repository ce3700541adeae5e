# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
from pathlib import Path

import pytest

from tree_sway.errors import FormatError, SpeciesError, TreeSwayError
from tree_sway.files.scenes.scene_yaml import parse_scene, read_scene_yaml
from tree_sway.files.trees.source import open_scene, open_tree
from tree_sway.files.yaml_document import begins_with_key, packaged_schema

DATA = Path(__file__).parents[1] / 'data'
CONFIG = Path(__file__).parents[3] / 'config'
ONE = 'trees:\n- {name: a, tree: seedling.yaml}\n'


def seedlings(name, seed, **how):
    """Any tree is the seedling; none is missing."""
    return open_tree(DATA / 'seedling.yaml', **how)


def test_trees_stand_where_the_file_says():
    text = """
    name: glade
    anemometer: [-5, 0, 10]
    convection_ratio: 1.5
    trees:
    - {name: a, tree: t, x: 1, y: 2, z: .5, yaw: 1.6, leaf_on: true}
    - {name: b, tree: t, species: birch}
    """
    forest = parse_scene(text, seedlings, Path('glade'))
    a, b = forest.trees
    assert (a.x, a.y, a.z, a.yaw, a.leaf_on) == (1.0, 2.0, 0.5, 1.6, True)
    assert (b.x, b.yaw, b.leaf_on) == (0.0, 0.0, None)
    assert (a.species.key, b.species.key, b.tree.species) == ('oak', 'birch', 'birch')
    assert a.species.modulus == 8e9  # the file's own, measured
    assert (forest.name, forest.anemometer, forest.convection_ratio) == ('glade', (-5, 0, 10), 1.5)


def test_a_path_counts_from_the_file_and_a_tree_is_read_once(tmp_path):
    (tmp_path / 'seedling.yaml').write_bytes((DATA / 'seedling.yaml').read_bytes())
    path = tmp_path / 'glade.yaml'
    path.write_text(
        ONE + '- {name: b, tree: ./seedling.yaml, x: 3}\n- {name: c, tree: seedling.yaml}\n'
    )
    opened = []

    def counted(name, seed, **how):
        opened.append(Path(name).name)
        return open_tree(name, seed, **how)

    forest = read_scene_yaml(path, counted)
    assert opened == ['seedling.yaml', 'seedling.yaml']  # './' is another spelling
    assert forest.name == 'glade'
    assert forest.tree.n_segments == 3 * 6
    assert open_scene(path).tree.segment_names == forest.tree.segment_names


def test_the_example_holds_three_trees():
    forest = open_scene(CONFIG / 'forest.yaml')
    assert len(forest.trees) == 3
    assert {each.leaf_on for each in forest.trees} == {True, False}


@pytest.mark.parametrize(
    ('text', 'message'),
    [
        ('', 'empty; describe a tree or a forest'),
        ('trees: []', 'glade:1: trees is a list of 0; give a list of at least 1'),
        ('trees: oak', "glade:1: trees is 'oak'; give a list of at least 1"),
        ('name: x', 'glade:1: no trees and no stand; give one of the two'),
        ('stand: a.csv\ntrees: [{name: a, tree: t}]', 'both trees and stand; give one of the two'),
        ('trees:\n- {tree: t}', r"glade:2: trees\[0\] has no 'name'"),
        ('trees:\n- {name: a}', r"glade:2: trees\[0\] has no 'tree'"),
        (
            'trees:\n- {name: a, tree: t, yaww: 1}',
            r"glade:2: unknown key 'yaww' in trees\[0\]; did you mean 'yaw'",
        ),
        ('trees:\n- {name: a, tree: t, x: 1 m}', r"trees\[0\].x is '1 m'; give a number"),
        ('trees:\n- {name: a, tree: t, x: .inf}', r"trees\[0\].x is '.inf'; give a number"),
        ('trees:\n- {name: a, tree: t, leaf_on: yes}', "leaf_on is 'yes'; give true or false"),
        ('trees:\n- {name: a, tree: t, leaf_on: [1]}', 'leaf_on is a list of 1; give true or'),
        ('trees:\n- {name: a, tree: t, seed: -1}', r"trees\[0\].seed is '-1'"),
        ('trees:\n- {name: a/b, tree: t}', "glade:2: a slash in the name 'a/b'"),
        (
            'trees:\n- {name: a, tree: t}\n- {name: a, tree: t}',
            "glade:3: two trees called 'a', the first in line 2",
        ),
        (
            'anemometer: [1, 2]\ntrees:\n- {name: a, tree: t}',
            'anemometer is a list of 2; give a list of at least 3',
        ),
        ('convection_ratio: 0\ntrees:\n- {name: a, tree: t}', "convection_ratio is '0'"),
    ],
)
def test_what_is_wrong_has_a_line_and_a_cure(text, message):
    with pytest.raises(FormatError, match=message):
        parse_scene(text, seedlings, Path('glade'))


def test_a_tree_that_cannot_be_opened_is_named(tmp_path):
    path = tmp_path / 'glade.yaml'
    path.write_text('name: glade\ntrees:\n- {name: fig, tree: benjamin}\n')
    where = r"glade.yaml:3: tree 'fig': "
    with pytest.raises(FormatError, match=where + "no tree 'benjamin'; did you mean 'benjamina'"):
        open_scene(path)
    path.write_text('trees:\n- {name: fig, tree: benjamina, species: figg}\n')
    with pytest.raises(SpeciesError, match=r"glade.yaml:2: tree 'fig': unknown species 'figg'"):
        open_scene(path)
    (tmp_path / 'bad.yaml').write_text('branches:\n- {name: stem, nodes: [[0, 0, 0, .1]]}\n')
    path.write_text('trees:\n- {name: oak, tree: bad.yaml}\n')
    with pytest.raises(
        FormatError, match=r"glade.yaml:2: tree 'oak': .*bad.yaml:2: .*is a list of 1"
    ):
        open_scene(path)


def test_a_forest_holds_no_forest_and_is_no_tree(tmp_path):
    path = tmp_path / 'glade.yaml'
    path.write_text('trees:\n- {name: inner, tree: glade.yaml}\n')
    with pytest.raises(FormatError, match=r"tree 'inner': .*a forest, where one tree is expected"):
        open_scene(path)
    with pytest.raises(
        FormatError, match=r'a forest, where one tree is expected; name one of its trees'
    ):
        open_tree(path)


def test_a_forest_is_known_by_its_trees(tmp_path):
    for name, text, wanted in (
        ('a.yaml', '# three\nname: x\ntrees:\n', True),
        ('a.json', '{"trees": []}', True),
        ('b.yaml', 'branches:\n- {name: trees}\n', False),
        ('a.csv', 'trees:\n', False),
    ):
        (tmp_path / name).write_text(text)
        assert begins_with_key(tmp_path / name, text, 'trees') is wanted


def test_the_schema_is_one_that_editors_take():
    validator = pytest.importorskip('jsonschema').Draft202012Validator
    schema = packaged_schema('scene_schema.json')
    validator.check_schema(schema)
    assert validator(schema).is_valid({'trees': [{'name': 'a', 'tree': 'b', 'leaf_on': True}]})
    assert not validator(schema).is_valid({'trees': [{'name': 'a'}]})
    with pytest.raises(TreeSwayError):
        parse_scene('trees:\n- {name: a}', seedlings, Path('glade'))
