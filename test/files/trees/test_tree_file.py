# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
from pathlib import Path

import pytest

from tree_sway.errors import FormatError, ParameterError, SpeciesError, TreeError
from tree_sway.files.scenes.inventory.inventory_file import inventory_table
from tree_sway.files.text_file import read_head
from tree_sway.files.trees.source import open_scene
from tree_sway.files.trees.tree_file import read_tree, read_trees

DATA = Path(__file__).parents[1] / 'data'


def test_content_decides_and_suffix_breaks_ties(tmp_path):
    for suffix in ('.yaml', '.txt', '.csv', ''):
        copy = tmp_path / f'tree{suffix}'
        copy.write_bytes((DATA / 'seedling.yaml').read_bytes())
        assert read_tree(copy).tree.n_branches == 4
    copy = tmp_path / 'table.yaml'
    copy.write_bytes((DATA / 'segments.csv').read_bytes())
    assert read_tree(copy).tree.n_segments == 3


def test_format_by_name():
    assert read_tree(DATA / 'segments.csv', format='csv').tree.n_branches == 2
    with pytest.raises(
        ParameterError, match="unknown tree format 'dwg'; use archi, simpleforest, rtwig, mtg, ply"
    ):
        read_tree(DATA / 'segments.csv', format='dwg')
    with pytest.raises(FormatError):
        read_tree(DATA / 'segments.csv', format='yaml')


def test_options_are_checked():
    assert read_tree(DATA / 'segments.csv', species='oak').species.key == 'oak'
    with pytest.raises(ParameterError, match="no option 'specie'; it has: species"):
        read_tree(DATA / 'segments.csv', specie='oak')
    with pytest.raises(SpeciesError):
        read_tree(DATA / 'segments.csv', species='baobab')


def test_unknown_content(tmp_path):
    (tmp_path / 'x.bin').write_bytes(b'\x00\x01\x02')
    with pytest.raises(
        FormatError, match='unknown tree format; give one of archi, simpleforest, rtwig, mtg'
    ):
        read_trees(tmp_path / 'x.bin')
    with pytest.raises(FormatError, match='no such file; check the path'):
        read_trees(tmp_path / 'none.csv')


def test_a_header_alone_is_said(tmp_path):
    (tmp_path / 'stand.csv').write_text('# measured in May\nspecies,height_m,dbh_cm\n')
    with pytest.raises(FormatError, match=r'stand\.csv: a header and no rows; write rows below'):
        read_trees(tmp_path / 'stand.csv')


@pytest.mark.parametrize(
    ('name', 'content', 'words'),
    [
        ('tree.usdz', b'PK\x03\x04' + bytes(26) + b'tree.usdc', 'a mesh for drawing'),
        ('tree.USDA', b'#usda 1.0', 'a mesh for drawing'),
        ('tree.glb', b'glTF\x02', 'give the file that it was made from'),
        ('tree.obj', b'v 0 0 0', 'a mesh for drawing'),
        ('tree.xml', b'<mujoco/>', 'a model for a robot simulator'),
        ('tree.sdf', b'<sdf/>', 'a model for a robot simulator'),
        ('tree.html', b'<!doctype html>', 'a page, not a tree'),
        ('scan.laz', b'LASF', 'a point cloud, not a tree; fit cylinders'),
        ('trees.zip', b'PK\x03\x04' + bytes(26) + b'trees.csv', 'unpack it first'),
    ],
)
def test_a_file_of_another_kind_is_named_with_the_formats_that_are_read(
    tmp_path, name, content, words
):
    (tmp_path / name).write_bytes(content)
    with pytest.raises(FormatError, match=words) as refused:
        open_scene(tmp_path / name)
    assert 'formats that are read: archi, simpleforest' in str(refused.value)


@pytest.mark.parametrize(
    'content',
    [
        '<Trees><count>2</count><RESULT><CODE>0</CODE><TEXT>OK</TEXT></RESULT><row><H>3</H></row>',
        '<trees>\n <tree id="1">\n  <name>Ulme</name>\n  <height/>\n  <x>3</x>\n  <y>4</y>',
        '<osm version="0.6"><node id="1" lat="48" lon="9"/><node id="2" lat="48" lon="9"/></osm>',
    ],
)
def test_rows_in_xml_are_asked_for_as_a_table(tmp_path, content):
    path = tmp_path / 'trees.xml'
    path.write_text('<?xml version="1.0" encoding="UTF-8"?>\n' + content, encoding='utf-8')
    with pytest.raises(FormatError, match='a table as XML, not a tree; ask for it as CSV or JSON'):
        open_scene(path)
    with pytest.raises(FormatError, match='a table as XML; ask for it as CSV or JSON'):
        inventory_table(path, read_head(path))


def test_a_spreadsheet_in_xml_is_named(tmp_path):
    path = tmp_path / 'trees.xml'
    path.write_text(
        '<?xml version="1.0"?>\n<?mso-application progid="Excel.Sheet"?>\n<Workbook><Worksheet>'
    )
    with pytest.raises(FormatError, match='a spreadsheet as XML, not a tree; save it as'):
        open_scene(path)


def test_models_in_xml_are_no_tables(tmp_path):
    path = tmp_path / 'tree.xml'
    path.write_text(
        '<sdf version="1.6"><model name="m"><static>true</static><pose>0</pose></model>'
    )
    with pytest.raises(FormatError, match='a model for a robot simulator'):
        open_scene(path)


def test_table_of_segments():
    tree = read_tree(DATA / 'segments.csv').tree
    assert list(tree.segment_parent) == [-1, 0, 0]
    assert list(tree.base_diameter) == [0.10, 0.08, 0.03]
    assert tree.height == 2.0


@pytest.mark.parametrize(
    ('old', 'new', 'kind', 'message'),
    [
        ('20,10,1', '11,10,1', FormatError, ':4: segment 11: number 11 occurs twice'),
        ('20,10,1', '20,99,1', TreeError, ':4: segment 20: orphan: its parent 99'),
        ('20,10,1', '20,10.5,1', FormatError, ':4: parent is 10.5, not a whole number'),
        ('20,10,1', '20,20,1', TreeError, ':4: segment 20: cyclic'),
        ('0.03,0.01', '0.03', FormatError, ":4: 10 cells, none for 'd1'"),
        ('0.03,0.01', '0.03,nan', FormatError, ":4: d1 is 'nan', not a finite number"),
        ('d0,d1', 'e0,e1', FormatError, ":1: no column 'd0' among segment, parent"),
    ],
)  # fmt: skip
def test_errors_of_a_table(tmp_path, old, new, kind, message):
    copy = tmp_path / 'broken.csv'
    copy.write_text((DATA / 'segments.csv').read_text().replace(old, new))
    with pytest.raises(kind, match=message):
        read_tree(copy, format='csv')
