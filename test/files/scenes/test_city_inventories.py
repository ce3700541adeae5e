# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Inventories with the headers of cities' open data and of foresters, rows made up."""

from __future__ import annotations

from contextlib import closing
import csv
import json
import math
from pathlib import Path
import sqlite3
import struct
import sys

import numpy as np
import pytest

from tree_sway.errors import FormatError, MissingDependencyError
from tree_sway.files.scenes.inventory.cell_number import cell_number, stems_number
from tree_sway.files.scenes.inventory.inventory_file import inventory_table
from tree_sway.files.scenes.inventory.read_inventory import Inventory, inventory_of
from tree_sway.files.text_file import read_head
from tree_sway.files.trees.source import open_scene

#: Head and rows; then species, height [m] and diameter [m] of each tree, None where not checked.
pytestmark = pytest.mark.usefixtures('readers_in_this_process')

CITIES = {
    'Tallinn': (
        'puu_id,liik,korgus,umbermoot,x,y\n'
        'TLN-1,Quercus robur,12.0,94,391234.5,5820123.4\n',
        [('oak', 12.0, 0.299)],
    ),
    'ForestGEO': (
        '"Plot","Mnemonic","Latin","Quadrat","PX","PY","TreeID","DBH","HOM"\n'
        '"scbi","quro","Quercus robur",0101,1.7,17.3,1,300.0,1.3\n'
        '"scbi","tico","Tilia cordata",0101,9.4,11.2,2,450.0,1.3\n',
        [('oak', None, 0.3), ('lime', None, 0.45)],
    ),
    'Berlin': (
        'standortnr;art_dtsch;art_bot;gattung;stammumfg;baumhöhe [m];x;y\n'
        '1;Gemeine Rosskastanie;Aesculus hippocastanum;AESCULUS;157,08;15,5;391234,5;5820123,4\n'
        '1;Hainbuche;Carpinus betulus;CARPINUS;94,25;12,0;391244,5;5820123,4\n'
        '3;Robinie;Robinia pseudoacacia;ROBINIA;126;;391254,5;5820123,4\n',
        [('horse_chestnut', 15.5, 0.5), ('hornbeam', 12.0, 0.3), ('robinia', None, 0.401)],
    ),
    'Vienna': (
        'FID,SHAPE,BAUM_ID,GATTUNG_ART,PFLANZJAHR,STAMMUMFANG,BAUMHOEHE,BAUMHOEHE_TXT\n'
        '1,POINT (16.3799 48.2218),101,Platanus x acerifolia (Platane),1930,212,3,11-15 m\n'
        '2,POINT (16.3801 48.2219),102,Celtis australis (Zürgelbaum),1930,112,0,nicht bekannt\n',
        [('plane', 13.0, 0.675), ('hackberry', None, 0.357)],
    ),
    'Paris': (
        'IDBASE;LIBELLE FRANCAIS;GENRE;ESPECE;CIRCONFERENCE (cm);HAUTEUR (m);geo_point_2d\n'
        '99874;Marronnier;Aesculus;hippocastanum;65;8;48.857620,2.320962\n'
        '99875;Sophora;Styphnolobium;japonicum;90;10;48.857621,2.320962\n'
        '99876;Micocoulier;Celtis;australis;0;0;48.857622,2.320962\n',
        [('horse_chestnut', 8.0, 0.207), ('pagoda_tree', 10.0, 0.286)],
    ),
    'New York, 2015': (
        'tree_id,tree_dbh,stump_diam,status,spc_latin,spc_common,latitude,longitude,x_sp,y_sp\n'
        '1,12,0,Alive,Gleditsia triacanthos var. inermis,honeylocust,40.723,-73.844,1027431,2027\n'
        '2,8,0,Alive,Ginkgo biloba,ginkgo,40.724,-73.844,1027432,2028\n'
        '3,0,14,Stump,,,40.725,-73.844,1027433,2029\n'
        '4,10,0,Alive,Pyrus calleryana,Callery pear,40.726,-73.844,1027434,2030\n',
        [('honey_locust', None, 0.305), ('ginkgo', None, 0.203), ('pear', None, 0.254)],
    ),
    'London': (
        'gla_tree_name,common_name,taxon_name,height_m,diameter_at_breast_height_cm,x,y\n'
        'London plane,London plane,Platanus x hispanica,18,60,530123.4,180456.7\n',
        [('plane', 18.0, 0.6)],
    ),
    'San Francisco': (
        'TreeID,qLegalStatus,qSpecies,DBH,XCoord,YCoord,Latitude,Longitude,Location\n'
        '7,DPW Maintained,Platanus x hispanica :: Sycamore: London Plane,12,6007001,2104002,'
        '37.76,-122.44,"(37.76, -122.44)"\n'
        '8,DPW Maintained,Tree(s) ::,3,6007011,2104002,37.761,-122.44,"(37.761, -122.44)"\n',
        [('plane', None, 0.305), ('broadleaf', None, 0.076)],
    ),
    'Melbourne': (
        'CoM ID,Common Name,Scientific Name,Genus,Diameter Breast Height,Latitude,Longitude,'
        'Easting,Northing\n'
        '1,London Plane,Platanus x acerifolia,Platanus,34,-37.8,144.96,320123.4,5814567.8\n',
        [('plane', None, 0.34)],
    ),
    'Vancouver': (
        'TREE_ID;GENUS_NAME;SPECIES_NAME;COMMON_NAME;HEIGHT_RANGE;DIAMETER;Geom\n'
        '9;ACER;PLATANOIDES;NORWAY MAPLE;30\' - 40\';12;"{""coordinates"": [-123.1, 49.24], '
        '""type"": ""Point""}"\n',
        [('maple', 10.668, 0.305)],
    ),
    'Amsterdam': (
        'Soortnaam;Boomhoogte;Stamdiameterklasse;LNG;LAT\n'
        "Ulmus 'Columella';12 tot 15 m.;0,3 tot 0,5 m.;4,9;52,37\n",
        [('elm', 13.5, 0.4)],
    ),
    'Toronto': (
        'OBJECTID,BOTANICAL_NAME,COMMON_NAME,DBH_TRUNK,geometry\n'
        '1,Acer saccharinum,Silver maple,48,"{""type"": ""MultiPoint"", ""coordinates"": '
        '[[-79.4, 43.66]]}"\n',
        [('silver_maple', None, 0.48)],
    ),
    'Hamburg': (
        'baumid,gattung_latein,art_latein,stammumfang,kronendurchmesser,WKT\n'
        '4,Tilia,Tilia cordata,120,9,POINT (565123.4 5934567.8)\n',
        [('lime', None, 0.382)],
    ),
    'i-Tree Eco': (
        'Tree ID,Species,DBH (in),Total Height (ft),Longitude,Latitude\n'
        '1,Red maple,18.2,52,-77.03,38.9\n',
        [('red_maple', 15.85, 0.462)],
    ),
    'a forest inventory': (
        'x_m,y_m,species_latin,dbh_mm\n0,0,Quercus robur,300\n4,0,Fagus sylvatica,250\n',
        [('oak', None, 0.3), ('beech', None, 0.25)],
    ),
    'OpenStreetMap, CSV of Overpass': (
        '@id\t@lat\t@lon\tspecies\tgenus\theight\tcircumference\n'
        '1\t52.5\t13.4\tTilia cordata\t\t12 m\t1.2\n2\t52.5\t13.41\t\tAcer\t\t0.9\n',
        [('lime', 12.0, 0.382), ('maple', None, 0.286)],
    ),
    'WKT and feet': (
        'WKT,species,height (ft),dbh_in\n"POINT (0 0)",oak,50,20\n"POINT (10 0)",oak,60,22\n',
        [('oak', 15.24, 0.508), ('oak', 18.288, 0.559)],
    ),
    'empty cells, dead trees, no stem': (
        'x,y,species,height,dbh,status\n'
        '0,0,oak,12,30,alive\n4,0,oak,,25,alive\n8,0,,11,,alive\n12,0,oak,,,alive\n'
        '16,0,oak,9,20,dead\n20,,oak,9,20,alive\n24,0,oak,,0,alive\n',
        [('oak', 12.0, 0.3), ('oak', None, 0.25), ('broadleaf', 11.0, None)],
    ),
    'young trees in inches, in whole numbers': (
        'tree_id,tree_dbh,spc_latin,latitude,longitude\n'
        '1,3,Acer rubrum,40.72,-73.84\n2,21,Quercus palustris,40.79,-73.81\n'
        '3,3,Gleditsia triacanthos,40.71,-73.93\n',
        [('red_maple', None, 0.076), ('oak', None, 0.533), ('honey_locust', None, 0.076)],
    ),
    'several stems, two columns of heights': (
        'x,y,species,dbh,HEIGHT,TreeHeight\n0,0,English oak,650mm,,14 m\n'
        '4,0,Silver birch,"320, 240",,11 m\n',
        [('oak', 14.0, 0.65), ('birch', 11.0, 0.4)],
    ),
    'inches by height': (
        'x,y,species,height,dbh\n0,0,oak,18,12\n9,0,oak,20,13\n',
        [('oak', 18.0, 0.305), ('oak', 20.0, 0.33)],
    ),
    'feet by diameter': (
        'x,y,species,height,dbh (in)\n0,0,oak,60,16\n9,0,oak,70,18\n',
        [('oak', 18.288, 0.406), ('oak', 21.336, 0.457)],
    ),
}  # fmt: skip


def read(path: Path) -> Inventory:
    return inventory_of(inventory_table(path, read_head(path)))


def check(inventory: Inventory, expected: list[tuple[str, float | None, float | None]]) -> None:
    assert [inventory.wood[each].key for each in inventory.species] == [
        key for key, *_ in expected
    ]
    for row, (_, height, diameter) in enumerate(expected):
        if height is not None:
            assert inventory.height[row] == pytest.approx(height, rel=1e-3)
        else:
            assert 2.0 < inventory.height[row] < 40.0
        if diameter is not None:
            assert inventory.diameter[row] == pytest.approx(diameter, rel=5e-3)
    assert np.isfinite(inventory.x + inventory.y).all()


@pytest.mark.parametrize('name', CITIES)
def test_it_is_read_as_it_is(name: str, tmp_path: Path) -> None:
    text, expected = CITIES[name]
    path = tmp_path / 'trees.csv'
    path.write_text(text, encoding='utf-8')
    check(read(path), expected)
    assert len(open_scene(path).trees) == len(expected)


@pytest.mark.parametrize('encoding', ['cp1252', 'utf-16', 'utf-8-sig'])
def test_encodings_of_spreadsheets(encoding: str, tmp_path: Path) -> None:
    text, expected = CITIES['Berlin']
    path = tmp_path / 'trees.csv'
    path.write_bytes(text.encode(encoding))
    check(read(path), expected)
    assert len(open_scene(path).trees) == len(expected)


def test_rows_are_left_out_by_reason_and_counted(tmp_path: Path) -> None:
    path = tmp_path / 'trees.csv'
    path.write_text(CITIES['empty cells, dead trees, no stem'][0])
    notes = '\n'.join(open_scene(path).notes)
    assert '4 rows are left out: 2 no height and no stem, 1 dead or gone, 1 no place' in notes
    assert "line 6: status is 'dead'" in notes
    assert '1 of 3 heights are those of grown trees of these stems' in notes
    assert 'trees without a species are taken as a broadleaf' in notes


def test_units_that_were_chosen_are_said(tmp_path: Path) -> None:
    path = tmp_path / 'trees.csv'
    path.write_text(CITIES['New York, 2015'][0])
    notes = '\n'.join(read(path).notes)
    assert 'tree_dbh is taken as inches, as the trees stand in the United States' in notes
    path.write_text(CITIES['inches by height'][0])
    assert 'dbh is taken as inches, by height over it' in '\n'.join(read(path).notes)
    path.write_text(CITIES['feet by diameter'][0])
    assert 'height is taken as feet, by height over diameter' in '\n'.join(read(path).notes)
    path.write_text('x,y,species,height [parsec]\n0,0,oak,12\n')
    assert "height [parsec]: 'parsec' is no known unit" in '\n'.join(read(path).notes)


def test_heights_in_another_unit_say_so(tmp_path: Path) -> None:
    path = tmp_path / 'trees.csv'
    path.write_text('x,y,species,height\n0,0,oak,1800\n4,0,oak,1700\n')
    with pytest.raises(FormatError, match=r'2 too high; line 2: .*1800 m; give its unit, as in h'):
        open_scene(path)
    path.write_text('x,y,species,height [cm]\n0,0,oak,1800\n4,0,oak,1700\n')
    assert open_scene(path).trees[0].placed().height == pytest.approx(18.0)


def test_trees_without_a_species_are_broadleaves(tmp_path: Path) -> None:
    path = tmp_path / 'trees.csv'
    path.write_text('x,y,height,dbh\n0,0,12,30\n4,0,14,33\n')
    scene = open_scene(path)
    assert {tree.species.key for tree in scene.trees} == {'broadleaf'}
    assert any('without a species' in note for note in scene.notes)


def test_names_that_occur_twice_are_numbered(tmp_path: Path) -> None:
    path = tmp_path / 'trees.csv'
    path.write_text(
        'name,x,y,species,height\na,0,0,oak,10\na,4,0,oak,9\na/b,8,0,oak,9\n,9,0,oak,9'
    )
    inventory = read(path)
    assert inventory.names == ('a', 'a-2', 'a-b', 'tree4')
    assert '2 names are changed' in '\n'.join(inventory.notes)


def feature(x: float, y: float, **properties: object) -> dict[str, object]:
    return {
        'type': 'Feature',
        'geometry': {'type': 'Point', 'coordinates': [x, y]},
        'properties': properties,
    }


@pytest.mark.parametrize('place', [(13.4, 52.5), (391234.5, 5820123.4)])
def test_geojson(place: tuple[float, float], tmp_path: Path) -> None:
    features = [feature(*place, art='Hainbuche', hoehe=12.5, umfang=94, latitude=None)]
    path = tmp_path / 'trees.geojson'
    path.write_text(json.dumps({'type': 'FeatureCollection', 'features': features}))
    check(read(path), [('hornbeam', 12.5, 0.299)])
    assert len(open_scene(path).trees) == 1
    path.write_text(path.read_text()[:-20])
    with pytest.raises(FormatError, match='not GeoJSON'):
        open_scene(path)


OAK = {'species': 'Quercus robur', 'height_m': 12, 'dbh_cm': 25}


@pytest.mark.parametrize(
    'document',
    [
        {'features': [{'attributes': OAK, 'geometry': {'x': 11.5, 'y': 48.1}}]},
        {'success': True, 'result': {'records': [OAK | {'x_wgs84': '11.5', 'y_wgs84': '48.1'}]}},
        {'results': [OAK | {'geo_point_2d': {'lon': 11.5, 'lat': 48.1}}]},
        {'records': [{'fields': OAK, 'geometry': {'type': 'Point', 'coordinates': [11.5, 48.1]}}]},
    ],
    ids=['ArcGIS', 'CKAN', 'Opendatasoft', 'Opendatasoft before'],
)
def test_json_of_portals(tmp_path: Path, document: dict[str, object]) -> None:
    path = tmp_path / 'trees.json'
    path.write_text(json.dumps(document))
    check(read(path), [('oak', 12.0, 0.25)])
    assert len(open_scene(path).trees) == 1


def test_places_on_maps_of_the_web_are_not_in_metres(tmp_path: Path) -> None:
    path = tmp_path / 'trees.json'
    found = {'attributes': OAK, 'geometry': {'x': 1280174.1, 'y': 6124759.3}}
    path.write_text(json.dumps({'spatialReference': {'wkid': 102100}, 'features': [found]}))
    with pytest.raises(FormatError, match='Web Mercator'):
        open_scene(path)


def test_openstreetmap(tmp_path: Path) -> None:
    tags = {'natural': 'tree', 'species': 'Aesculus hippocastanum', 'height': '14'}
    path = tmp_path / 'trees.json'
    elements = [{'type': 'node', 'id': 1, 'lat': 52.5, 'lon': 13.4, 'tags': tags}]
    path.write_text(json.dumps({'version': 0.6, 'elements': elements}))
    check(read(path), [('horse_chestnut', 14.0, None)])
    assert len(open_scene(path).trees) == 1


@pytest.mark.parametrize(
    'broken',
    [
        *(
            {'geometry': {'type': 'Point', 'coordinates': coordinates}}
            for coordinates in ([1], [[1], 2], [10**400, 48.8], [1, 'x'], [math.nan, 1], 'x', {})
        ),
        *({'geometry': geometry} for geometry in ([], 'x', None)),
        {'properties': []},
        {'properties': 'x', 'geometry': None},
    ],
)  # fmt: skip
def test_a_broken_feature_of_geojson_alone_is_left_out(
    broken: dict[str, object], tmp_path: Path
) -> None:
    good = [feature(13.4 + 1e-4 * k, 52.5, art='Eiche', hoehe=12) for k in range(2)]
    path = tmp_path / 'trees.geojson'
    features = [good[0], good[0] | broken, good[1]]
    path.write_text(json.dumps({'type': 'FeatureCollection', 'features': features}))
    inventory = read(path)
    assert len(inventory.names) == 2
    assert any('1 row is left out' in note and 'feature 2: ' in note for note in inventory.notes)
    path.write_text(json.dumps({'type': 'FeatureCollection', 'features': [good[0], 'x', None]}))
    assert len(read(path).names) == 1


def test_geojson_without_any_place_says_so(tmp_path: Path) -> None:
    path = tmp_path / 'trees.geojson'
    one = feature(1, 2, art='Eiche', hoehe=12) | {'geometry': {'coordinates': [1]}}
    path.write_text(json.dumps({'type': 'FeatureCollection', 'features': [one]}))
    with pytest.raises(FormatError, match=r'no column for the place .* among art, hoehe'):
        read(path)


def test_one_feature_of_geojson(tmp_path: Path) -> None:
    path = tmp_path / 'tree.geojson'
    path.write_text(json.dumps(feature(13.4, 52.5, art='Hainbuche', hoehe=12.5)))
    check(read(path), [('hornbeam', 12.5, None)])


def test_measurements_in_a_list_of_records_are_read(tmp_path: Path) -> None:
    """As pytreedb has them: of each name the first record with a value."""
    measured = [{'source': 'TLS', 'height_m': 22.5}, {'DBH_cm': 25.0, 'height_m': 21.0}]
    path = tmp_path / 'tree.geojson'
    one = feature(8.6, 49.0, species='Betula pendula', measurements=measured)
    path.write_text(json.dumps(one))
    check(read(path), [('birch', 22.5, 0.25)])


def test_neighbours_on_both_sides_of_the_date_line_stand_side_by_side(tmp_path: Path) -> None:
    path = tmp_path / 'taveuni.csv'
    rows = ('oak,12,-16.8,179.9999', 'oak,12,-16.8,-179.9999', 'oak,12,-16.8,180.0002')
    path.write_text('species,height,latitude,longitude\n' + '\n'.join(rows) + '\n')
    x = [each.x for each in open_scene(str(path)).trees]
    degree = 6.371e6 * math.cos(math.radians(16.8)) * math.pi / 180.0
    assert x == pytest.approx([0.0, 2e-4 * degree, 3e-4 * degree], abs=1e-3)


def test_openstreetmap_without_a_longitude(tmp_path: Path) -> None:
    tags = {'natural': 'tree', 'species': 'Aesculus hippocastanum', 'height': '14'}
    elements = [{'lat': 52.5, 'tags': tags}, {'lat': 52.5, 'lon': 13.4, 'tags': tags}]
    path = tmp_path / 'trees.json'
    path.write_text(json.dumps({'elements': elements}))
    check(read(path), [('horse_chestnut', 14.0, None)])


@pytest.mark.parametrize(
    'cell',
    [
        'POINT (13.4 52.5)',
        'SRID=4326;POINT(13.4 52.5)',
        '<http://www.opengis.net/def/crs/OGC/1.3/CRS84> Point(13.4 52.5)',
        '{"type": "Point", "crs": {"name": "EPSG:4326"}, "coordinates": [13.4, 52.5]}',
    ],
)
def test_the_number_of_a_reference_system_is_no_place(cell: str, tmp_path: Path) -> None:
    cells = [cell, cell.replace('13.4', '13.401')]
    path = tmp_path / 'trees.csv'
    with path.open('w', newline='') as file:
        rows = [[each, 'oak', 12] for each in cells]
        csv.writer(file).writerows([['geometry', 'species', 'height'], *rows])
    inventory = read(path)
    assert inventory.x == pytest.approx([0.0, 67.7], abs=0.1)
    assert inventory.y == pytest.approx([0.0, 0.0], abs=1e-6)


def test_one_wrong_place_leaves_the_others_in_degrees(tmp_path: Path) -> None:
    path = tmp_path / 'trees.csv'
    places = ['POINT (13.4 52.5)', 'POINT (1340 52.5)', 'POINT (13.401 52.5)', 'POINT (1e400 5)']
    path.write_text('\n'.join(['geometry,species,height', *(f'{each},oak,12' for each in places)]))
    inventory = read(path)
    assert inventory.lines == (2, 4)
    assert inventory.x == pytest.approx([0.0, 67.7], abs=0.1)


def test_a_species_of_signs_alone_is_a_broadleaf(tmp_path: Path) -> None:
    path = tmp_path / 'trees.csv'
    path.write_text('x,y,species,height\n0,0,????,12\n9,0,oak,12\n')
    check(read(path), [('broadleaf', 12.0, None), ('oak', 12.0, None)])


def geopackage(path: Path, system: int, place: tuple[float, float]) -> None:
    """Write a layer of one point as GDAL does, as far as it is read."""
    geometry = b'GP\0\1' + struct.pack('<i', system) + b'\1' + struct.pack('<I2d', 1, *place)
    with closing(sqlite3.connect(path)) as base:
        base.executescript(
            'CREATE TABLE gpkg_contents (table_name TEXT, data_type TEXT);'
            'CREATE TABLE gpkg_geometry_columns (table_name TEXT, column_name TEXT, srs_id INT);'
            "INSERT INTO gpkg_contents VALUES ('trees', 'features');"
            f"INSERT INTO gpkg_geometry_columns VALUES ('trees', 'geom', {system});"
            'CREATE TABLE trees (fid INTEGER, geom BLOB, species TEXT, height REAL, dbh_cm REAL);'
        )
        for fid in (1, 2):
            base.execute(
                'INSERT INTO trees VALUES (?, ?, ?, ?, ?)', (fid, geometry, 'Ginkgo', 11.0, 25.0)
            )
        base.commit()


@pytest.mark.parametrize(
    ('system', 'place'),
    [(4326, (13.4, 52.5)), (25833, (391234.5, 5820123.4)), (3857, (1491681.2, 6891041.7))],
)
def test_geopackage(system: int, place: tuple[float, float], tmp_path: Path) -> None:
    path = tmp_path / 'trees.gpkg'
    geopackage(path, system, place)
    check(read(path), [('ginkgo', 11.0, 0.25)] * 2)
    assert len(open_scene(path).trees) == 2
    path.write_bytes(path.read_bytes()[:4096])
    with pytest.raises(FormatError, match=r'GeoPackage|no layer'):
        open_scene(path)


def test_spreadsheet(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    openpyxl = pytest.importorskip('openpyxl', reason='the extra inventory is not installed')
    book = openpyxl.Workbook()
    sheet = book.active
    sheet.append(['Baumkataster 2024'])
    sheet.append(['x', 'y', 'Baumart', 'Baumhöhe [m]', 'Stammumfang (cm)'])
    sheet.append([0, 0, 'Hainbuche', 12.5, 94])
    sheet.append([None] * 5)
    sheet.append([5, 0, 'Roßkastanie', None, 126])
    path = tmp_path / 'trees.xlsx'
    book.save(path)
    inventory = read(path)
    check(inventory, [('hornbeam', 12.5, 0.299), ('horse_chestnut', None, 0.401)])
    assert inventory.lines == (3, 5)
    assert len(open_scene(path).trees) == 2
    (tmp_path / 'cut.xlsx').write_bytes(path.read_bytes()[:1000])
    with pytest.raises(FormatError, match='not a spreadsheet that can be read'):
        open_scene(tmp_path / 'cut.xlsx')
    monkeypatch.setitem(sys.modules, 'openpyxl', None)
    with pytest.raises(MissingDependencyError, match='openpyxl'):
        open_scene(path)


@pytest.mark.parametrize(
    'above',
    [
        [],
        [['Trees', 'of', 'the park', 'in 2024']],
        [['surveyor', 'day'], ['A. Smith', 'Monday']],
    ],
)
def test_header_of_a_spreadsheet(above: list[list[str]], tmp_path: Path) -> None:
    openpyxl = pytest.importorskip('openpyxl', reason='the extra inventory is not installed')
    book = openpyxl.Workbook()
    other, sheet = book.active, book.create_sheet('trees')
    for row in (['plot', 'x', 'y', 'time'], [1, 0, 0, 2024]):
        other.append(row)
    for cells in [*above, ['species', 'height'], ['oak', 12], ['ash', 13.5]]:
        sheet.append(cells)
    path = tmp_path / 'trees.xlsx'
    book.save(path)
    inventory = inventory_of(inventory_table(path, read_head(path)), needs_place=False)
    check(inventory, [('oak', 12.0, None), ('ash', 13.5, None)])


@pytest.mark.parametrize(
    ('text', 'expected'),
    [
        ('12', (12.0, '')),
        ('12,5 m', (12.5, 'm')),
        ('6-10 m', (8.0, 'm')),
        ("30' - 40'", (35.0, "'")),
        ('12 tot 15 m.', (13.5, 'm')),
        ('> 35', (35.0, '')),
        ('ten', None),
        ('3 stems', None),
        ('-4', (-4.0, '')),
        ('320, 280', None),
        ('nan', None),
    ],
)
def test_numbers_as_people_write_them(text: str, expected: tuple[float, str] | None) -> None:
    assert cell_number(text) == expected


@pytest.mark.parametrize(
    ('text', 'expected'),
    [('30+40', (50.0, '')), ('320, 240 mm', (400.0, 'mm')), ('12,5', (12.5, '')), ('30+x', None)],
)
def test_several_stems_have_the_sum_of_their_sections(
    text: str, expected: tuple[float, str] | None
) -> None:
    assert stems_number(text) == expected
