# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Inventories as cities and surveys publish them: read as they are, or refused with the cure."""

from __future__ import annotations

from pathlib import Path
from zipfile import ZipFile

import pytest

from tree_sway.errors import FormatError
from tree_sway.files.trees.source import open_scene

#: Head of each as its pages describe it with rows made up; species and heights [m] expected.
READ = {
    'Berlin, Baumbestand': (
        'gml_id;baumid;standortnr;artdtsch;art_bot;pflanzjahr;stammumfg;baumhoehe;x;y\n'
        's_1;81;35;Winter-Linde;Tilia cordata;1965;127;14,5;389102,5;5820112,1\n'
        's_2;82;36;Spitz-Ahorn;Acer platanoides;1970;110;12;389110,0;5820119,3\n',
        [('lime', 14.5), ('maple', 12.0)],
    ),
    'Wien, Baumkataster': (
        'OBJECTID,SHAPE,BAUM_ID,GATTUNG_ART,PFLANZJAHR,STAMMUMFANG,BAUMHOEHE\n'
        '1,POINT (16.3799 48.2218),101,Platanus x acerifolia (Platane),1930,212,14\n'
        '2,POINT (16.3801 48.2219),102,Tilia cordata (Winterlinde),1930,112,13\n',
        [('plane', 14.0), ('lime', 13.0)],
    ),
    'Paris, les arbres': (
        'IDBASE;LIBELLE FRANCAIS;GENRE;ESPECE;CIRCONFERENCE (cm);HAUTEUR (m);geo_point_2d\n'
        '99874;Tilleul;Tilia;tomentosa;65;8;48.857620,2.320962\n',
        [('lime', 8.0)],
    ),
    'i-Tree Eco': (
        'Tree ID,Species,DBH (in),Total Height (ft),Longitude,Latitude\n'
        '1,Silver maple,18.2,52,-77.03,38.9\n2,White oak,24,60,-77.031,38.9001\n',
        [('silver_maple', 15.85), ('oak', 18.29)],
    ),
    'NEON, vegetation structure': (
        'uid,plotID,scientificName,easting,northing,stemDiameter,height,plantStatus\n'
        'a,HARV_001,Quercus rubra L.,732123.4,4713230.1,32.4,21.3,Live\n'
        'b,HARV_001,Tsuga canadensis (L.) Carr.,732125.4,4713232.1,12.4,9.3,Live\n',
        [('oak', 21.3), ('conifer', 9.3)],
    ),
    'Melbourne, urban forest': (
        'CoM ID,Common Name,Scientific Name,Diameter Breast Height,Latitude,Longitude\n'
        '1028628,London Plane,Platanus x acerifolia,34,-37.8,144.96\n',
        [('plane', None)],
    ),
    'a list in Finnish': (
        'plot;tree;x;y;puulaji;lpm;pituus\n1;1;2,3;4,5;kuusi;21,3;17,2\n',
        [('spruce', 17.2)],
    ),
    'New York, street trees': (
        'tree_id,tree_dbh,status,spc_latin,latitude,longitude\n'
        '180683,12,Alive,Acer rubrum,40.72309177,-73.84421522\n'
        '200540,21,Alive,Quercus palustris,40.79411067,-73.81867946\n',
        [('red_maple', None), ('oak', None)],
    ),
    'FIA, with all its columns': (
        'CN,PLT_CN,INVYR,STATECD,UNITCD,COUNTYCD,PLOT,SUBP,TREE,AZIMUTH,DIST,STATUSCD,SPCD,DIA,HT\n'
        '1,9,2019,10,1,1,5,1,1,45,10.5,1,318,9.84,39.4\n',
        [('maple', 39.4 * 0.3048)],
    ),
    'FIA, by codes and azimuths': (
        'CN,TREE,SPCD,DIA,HT,AZIMUTH,DIST\n1,1,131,9.6,55,120,10.2\n',
        [('pine', 55 * 0.3048)],
    ),
}

REFUSED = {
    'lidR, tree tops without species': (
        'treeID,X,Y,Z\n1,273364.5,5274361.0,18.2\n',
        'the species and none for the size .* among',
    ),
    'a list of codes': (
        'plot;tree;x;y;code;lpm7;pit\n1;1;2,3;4,5;2;21,3;17,2\n',
        'the species and none for the size .* among',
    ),
}


ABOVE = (
    'Baumkataster;;;;\nStand 2024, Anzahl 2;;;;\n\n'
    'Baumart;Höhe;BHD;Rechtswert;Hochwert\n;m;cm;m;m\n'
    'Quercus robur;18,5;40;390000,0;5820000,0\nTilia cordata;12;25;390010,0;5820005,0\n'
)


@pytest.mark.parametrize('is_packed', [False, True])
def test_lines_above_and_units_below_a_header_are_none_of_its_trees(
    tmp_path: Path, is_packed: bool
) -> None:
    path = written(tmp_path, ABOVE)
    if is_packed:
        path = tmp_path / 'trees.zip'
        with ZipFile(path, 'w') as archive:
            archive.writestr('liesmich.md', 'two trees')
            archive.writestr('trees.csv', ABOVE)
    scene = open_scene(path)
    assert [each.species.key for each in scene.trees] == ['oak', 'lime']
    heights = [each.scale * each.tree.height for each in scene.trees]
    assert heights == pytest.approx([18.5, 12.0], rel=1e-3)
    assert scene.trees[1].x - scene.trees[0].x == pytest.approx(10.0)
    assert not any('left out' in note for note in scene.notes)


def written(folder: Path, text: str) -> Path:
    """Write an inventory."""
    path = folder / 'trees.csv'
    path.write_text(text, encoding='utf-8')
    return path


@pytest.mark.parametrize('name', READ)
def test_it_is_read_as_it_is(tmp_path: Path, name: str) -> None:
    text, expected = READ[name]
    scene = open_scene(written(tmp_path, text))
    assert [each.species.key for each in scene.trees] == [key for key, _ in expected]
    for tree, (_, height) in zip(scene.trees, expected, strict=True):
        own = tree.scale * tree.tree.height
        assert own == pytest.approx(height, rel=1e-3) if height else 5.0 < own < 30.0
    if any(height is None for _, height in expected):
        assert any('heights are those of grown trees' in note for note in scene.notes)


@pytest.mark.parametrize('name', REFUSED)
def test_it_is_refused_with_the_cure(tmp_path: Path, name: str) -> None:
    text, missing = REFUSED[name]
    with pytest.raises(FormatError, match=f'no column for {missing}.*; name them so in the head'):
        open_scene(written(tmp_path, text))


@pytest.mark.parametrize('cell', ['POINT (nan 48.2)', 'somewhere', '48.2 16.3 200'])
def test_a_place_that_is_none_is_named(tmp_path: Path, cell: str) -> None:
    text = f'SHAPE,species,height\n{cell},oak,12\n'
    with pytest.raises(FormatError, match=r'line 2: .* is no latitude and longitude'):
        open_scene(written(tmp_path, text))
