# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Cells of inventories as people fill them: units of their own, remarks of several lines."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest

from tree_sway.files.scenes.inventory.cell_number import cell_number
from tree_sway.files.trees.source import open_scene


def opened(tmp_path: Path, text: str) -> Any:
    path = tmp_path / 'trees.csv'
    path.write_text(text, encoding='utf-8')
    return open_scene(path)


def heights(scene: Any) -> list[float]:
    return [each.scale * each.tree.height for each in scene.trees]


def test_each_cell_has_its_own_unit(tmp_path: Path) -> None:
    rows = (
        'species,height,x,y\noak,12,0,0\noak,39 ft,10,0\noak,12 m,20,0\noak,11,30,0\noak,9,40,0\n'
    )
    scene = opened(tmp_path, rows)
    assert heights(scene) == pytest.approx([12.0, 39 * 0.3048, 12.0, 11.0, 9.0])
    assert '2 cells of height have a unit of their own' in scene.notes


def test_a_unit_of_most_cells_is_that_of_the_others(tmp_path: Path) -> None:
    rows = 'species,height,x,y\noak,40 ft,0,0\noak,39 ft,10,0\noak,12 m,20,0\noak,30,30,0\n'
    scene = opened(tmp_path, rows)
    assert heights(scene) == pytest.approx([40 * 0.3048, 39 * 0.3048, 12.0, 30 * 0.3048])
    assert '1 cells of height without a unit are taken as ft' in scene.notes


def test_a_cell_with_another_unit_than_the_header(tmp_path: Path) -> None:
    rows = 'species,height [m],dbh [cm],x,y\noak,39 ft,300 mm,0,0\noak,12,30,10,0\n'
    scene = opened(tmp_path, rows)
    assert heights(scene) == pytest.approx([39 * 0.3048, 12.0])
    assert len(scene.kinds) == 1


def test_a_remark_of_several_lines_is_one_cell(tmp_path: Path) -> None:
    rows = (
        'name,species,"height\n[m]",x,y,remark\n'
        'a,oak,12,0,0,"crown reduced\n\nin 2023, ""fungi"""\n'
        '"b\nold",oak,13,10,0,\n'
        'c,oak,14,20,0,trunk of 12"\n'
        'd,oak,15,30,0,\n'
    )
    scene = opened(tmp_path, rows)
    assert heights(scene) == pytest.approx([12.0, 13.0, 14.0, 15.0])
    assert [each.name for each in scene.trees] == ['a', 'b old', 'c', 'd']


def test_a_tree_beyond_its_habit_is_scaled(tmp_path: Path) -> None:
    scene = opened(tmp_path, 'species,height,x,y\noak,0.5,0,0\nspruce,70,10,0\noak,12,20,0\n')
    assert heights(scene) == pytest.approx([0.5, 70.0, 12.0])
    assert any('scaled from one of 1 m' in note for note in scene.notes)


@pytest.mark.parametrize('number', ['1.234,5', '1,234.5', "1'234.5", '1234.5', '1234,5'])
def test_thousands_are_no_range(number: str) -> None:
    assert cell_number(number) == (1234.5, '')
    assert cell_number(f'{number} m') == (1234.5, 'm')


@pytest.mark.parametrize(
    ('text', 'number'),
    [
        ('f. 24 m. en hoger', (24.0, 'm')),
        ('60 ft and over', (60.0, 'ft')),
        ('25 m und höher', (25.0, 'm')),
    ],
)
def test_the_highest_class_has_its_least_number(text: str, number: tuple[float, str]) -> None:
    assert cell_number(text) == number


LAS_VEGAS = (
    'OBJECTID,BOTANICAL,COMMON,DBH,HEIGHT,COND,X,Y\n'
    '1,Fraxinus velutina,ARIZONA ASH,19-24,31-45,Good,-115.2,36.2\n'
    '2,Pinus eldarica,MONDEL PINE,13-18,16-30,Fair,-115.2001,36.2001\n'
    '3,Quercus virginiana,LIVE OAK,1-6,1-15,Dead,-115.2002,36.2002\n'
    '4,Fraxinus velutina,ARIZONA ASH,25-30,46-60,Good,-115.2003,36.2003\n'
)


def test_classes_of_feet_beside_thick_stems_are_feet(tmp_path: Path) -> None:
    scene = opened(tmp_path, LAS_VEGAS)
    assert heights(scene) == pytest.approx([38 * 0.3048, 23 * 0.3048, 53 * 0.3048])
    assert 'HEIGHT is taken as feet, by height over diameter' in scene.notes


def test_dead_trees_are_told_by_the_columns_of_cities(tmp_path: Path) -> None:
    notes = '\n'.join(opened(tmp_path, LAS_VEGAS).notes)
    assert "1 row is left out: 1 dead or gone; line 4: COND is 'Dead'" in notes
    buenos_aires = (
        'estado_plantera,nombre_cientifico,diametro_altura_pecho,altura_arbol,long,lat\n'
        'Ocupada,Fraxinus pennsylvanica,25,11,-58.4771,-34.6459\n'
        'Tocón,Tipuana tipu,70,0,-58.4774,-34.6462\n'
    )
    scene = opened(tmp_path, buenos_aires)
    assert heights(scene) == pytest.approx([11.0])


def test_a_stem_of_no_tree_is_said(tmp_path: Path) -> None:
    paris = (
        'LIBELLE FRANCAIS,CIRCONFERENCE (cm),HAUTEUR (m),geo_point_2d\n'
        'Platane,110,12,"48.8566, 2.3001"\n'
        'Sophora,250050,10,"48.8568, 2.3003"\n'
    )
    notes = '\n'.join(opened(tmp_path, paris).notes)
    assert "1 cells of CIRCONFERENCE (cm) do not count: line 3 is '250050'" in notes


def test_places_in_degrees_minutes_and_seconds(tmp_path):
    path = tmp_path / 'trees.csv'
    path.write_text(
        'Baumart,Höhe,BHD,Breite,Länge\n'
        'Spitzahorn,12,25,"52°30\'00""N","13°24\'00""E"\n'
        'Winterlinde,18,48,"52°30\'03.6""N","13°24\'00""E"\n',
        encoding='utf-8',
    )
    trees = open_scene(path, warn=False).trees
    assert trees[1].y - trees[0].y == pytest.approx(math.radians(0.001) * 6.371e6, rel=1e-6)
    assert trees[1].x == trees[0].x


def test_places_of_a_census_plot(tmp_path):
    path = tmp_path / 'census.csv'
    path.write_text(
        'treeID,sp,gx,gy,dbh\n1,oak,0.0,0,250\n2,oak,2.5,3,480\n3,oak,5.0,6,180\n', 'utf-8'
    )
    trees = open_scene(path, warn=False).trees
    assert [(each.x, each.y) for each in trees] == [(0.0, 0.0), (2.5, 3.0), (5.0, 6.0)]
