# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Inventories of cities and foresters in a dozen languages, with heads as they publish them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tree_sway.errors import FormatError
from tree_sway.files.scenes.inventory.inventory_file import inventory_table
from tree_sway.files.scenes.inventory.read_inventory import Inventory, inventory_of
from tree_sway.files.text_file import read_head

#: Head and rows; then species, height [m] or None where it is that of the stem, diameter [m].
READ = {
    'Berlin by ETRS89': (
        'OBJECTID;Baumart;Gattung;Baumhöhe [m];Stammumfang [cm];X_ETRS89;Y_ETRS89\n'
        '1;Winterlinde;Tilia cordata;14,5;110;391234,5;5821234,2\n'
        '2;Hainbuche;Carpinus betulus;9,5;70;391254,5;5821230,0\n',
        [('lime', 14.5, 0.35), ('hornbeam', 9.5, 0.223)],
    ),
    'Montreal': (
        'INV_TYPE,EMP_NO,Coord_X,Coord_Y,Essence_latin,Essence_fr,DHP,Longitude,Latitude\n'
        'R,1,291480.92,5040747.6,Acer saccharum,Erable à sucre,37,-73.6612,45.5034\n'
        'R,2,291490.92,5040740.6,Gleditsia triacanthos,Févier,22,-73.6613,45.5035\n',
        [('maple', None, 0.37), ('honey_locust', None, 0.22)],
    ),
    'Geneva': (
        'ID_ARBRE;NOM_COMPLET;CIRCONFERENCE;DIAMETRE_1M;HAUTEUR_TOTALE;E;N\n'
        '1;Fagus sylvatica;190;60;18;2500000.5;1118000.2\n'
        '2;Quercus robur;240;76;20;2500012.5;1118003.2\n',
        [('beech', 18.0, 0.6), ('oak', 20.0, 0.76)],
    ),
    'Madrid': (
        'Distrito;Nº inventario;Nombre científico;Perímetro (cm);Altura (m);Coord X;Coord Y\n'
        'Centro;1;Platanus x hybrida;120;14,5;440100,2;4474200,1\n'
        'Centro;2;Ulmus pumila;80;9,0;440110,2;4474203,1\n',
        [('plane', 14.5, 0.382), ('elm', 9.0, 0.255)],
    ),
    'Amsterdam': (
        'OBJECTNUMMER;Soortnaam_NL;Soortnaam_WTS;Boomhoogte;Stamdiameter;LNG;LAT;WKT_LNG_LAT\n'
        '1;Iep;Ulmus hollandica;c. 9 tot 12 m.;30;4.9012;52.3712;POINT(4.9012 52.3712)\n'
        '2;Linde;Tilia europaea;d. 12 tot 15 m.;45;4.9014;52.3713;POINT(4.9014 52.3713)\n',
        [('elm', 10.5, 0.3), ('lime', 13.5, 0.45)],
    ),
    'Copenhagen': (
        'FID,bydelsnavn,traeart,dansk_navn,slaegt,stammeomfang,traehojde,wkb_geometry\n'
        'x.1,Indre By,Tilia cordata,Lind,Tilia,110,12,POINT (12.5683 55.6761)\n'
        'x.2,Indre By,Aesculus hippocastanum,Kastanie,Aesculus,180,15,POINT (12.5685 55.6762)\n',
        [('lime', 12.0, 0.35), ('horse_chestnut', 15.0, 0.573)],
    ),
    'Helsinki': (
        'id,suku,laji,suomenknimi,korkeus,lapimitta,x,y\n'
        '1,Tilia,cordata,metsälehmus,14,35,25496000,6672000\n'
        '2,Betula,pendula,rauduskoivu,16,28,25496010,6672004\n',
        [('lime', 14.0, 0.35), ('birch', 16.0, 0.28)],
    ),
    'Warsaw': (
        '_id,x_wgs84,y_wgs84,x_pl2000,y_pl2000,gatunek,gatunek_1,wysokosc,pnie_obwod\n'
        '1,21.0123,52.2312,7500000,5788000,klon pospolity,Acer platanoides,8,55\n'
        '2,21.0125,52.2313,7500012,5788008,lipa drobnolistna,Tilia cordata,12,110\n',
        [('maple', 8.0, 0.175), ('lime', 12.0, 0.35)],
    ),
    'Buenos Aires': (
        'long,lat,nro_registro,nombre_cientifico,diametro_altura_pecho,altura_arbol\n'
        '-58.3712,-34.6412,1,Jacaranda mimosifolia,32,11\n'
        '-58.3713,-34.6413,2,Fraxinus pennsylvanica,25,9\n',
        [('broadleaf', 11.0, 0.32), ('ash', 9.0, 0.25)],
    ),
    'Tokyo': (
        '番号,樹種,樹高(m),胸高直径(cm),経度,緯度\n'
        '1,ケヤキ,15,45,139.7012,35.6812\n2,イチョウ,18,50,139.7014,35.6813\n',
        [('zelkova', 15.0, 0.45), ('ginkgo', 18.0, 0.5)],
    ),
    'Seattle, X and Y in degrees, feet and inches without saying so': (
        'X,Y,OBJECTID,COMPKEY,SCIENTIFIC_NAME,COMMON_NAME,DIAM,TREEHEIGHT\n'
        '-122.335167,47.608013,1,1,Quercus rubra,Red oak,14,45\n'
        '-122.335301,47.608141,2,2,Acer platanoides,Norway Maple,9,30\n',
        [('oak', 13.716, 0.356), ('maple', 9.144, 0.229)],
    ),
    'Washington': (
        'X,Y,SCI_NM,CMMN_NM,GENUS_NAME,FAM_NAME,DBH,TREES_ID\n'
        '-77.034512,38.901234,Quercus phellos,Willow oak,Quercus,Fagaceae,21.4,1\n'
        '-77.034634,38.901345,Ulmus americana,American elm,Ulmus,Ulmaceae,17.0,2\n',
        [('oak', None, 0.544), ('elm', None, 0.432)],
    ),
    'a map of ArcGIS': (
        'OBJECTID_1,Botanical,Common,Trunk_Dia_in,Ht_ft,POINT_X,POINT_Y\n'
        '1,Quercus virginiana,Southern live oak,24,40,-95.361234,29.761234\n'
        '2,Pinus taeda,Loblolly pine,18,75,-95.361345,29.761345\n',
        [('oak', 12.192, 0.61), ('pine', 22.86, 0.457)],
    ),
    'i-Tree': (
        'Tree ID;Species;DBH (in);Total Height (ft);Latitude;Longitude;Crown Base\n'
        '1;Red maple;12;35;40.1;-75.1;6\n2;White oak;20;60;40.1001;-75.1001;9\n',
        [('red_maple', 10.668, 0.305), ('oak', 18.288, 0.508)],
    ),
    'a German forester': (
        'Baum Nr.,BA,BHD,H,Rechtswert,Hochwert\n1,Fi,32,24,3500000,5800000\n'
        '2,Ei,40,26,3500005,5800004\n3,Kie,30,20,3500009,5800001\n4,Dgl,45,30,3500019,5800001\n',
        [('spruce', 24.0, 0.32), ('oak', 26.0, 0.4), ('pine', 20.0, 0.3),
         ('douglas_fir', 30.0, 0.45)],
    ),
    'a Swedish forester': (
        'Träd;Trädslag;Brösthöjdsdiameter (mm);Höjd (dm);Öst;Nord\n'
        '1;Gran;320;240;600000;6600000\n2;Tall;280;205;600004;6600005\n',
        [('spruce', 24.0, 0.32), ('pine', 20.5, 0.28)],
    ),
    'Perth, a shapefile': (
        'TREE_ID,BOTANICAL_,COMMON_NAM,TREE_HEIGH,LONGITUDE,LATITUDE\n'
        '1,Eucalyptus marginata,Jarrah,14,115.8612,-31.9512\n'
        '2,Jacaranda mimosifolia,Jacaranda,9,115.8614,-31.9513\n',
        [('eucalyptus', 14.0, None), ('broadleaf', 9.0, None)],
    ),
    'Providencia': (
        'X;Y;NOMB_CIENT;SP;H_MTS;DAP\n'
        '350100,5;6298700,1;Platanus orientalis;PLO;14,5;42\n'
        '350112,5;6298703,2;Robinia pseudoacacia;ROP;9,0;25\n',
        [('plane', 14.5, 0.42), ('robinia', 9.0, 0.25)],
    ),
    'Belfast': (
        'TYPEOFTREE,SPECIESTYPE,SPECIES,DIAMETERinCENTIMETRES,TREEHEIGHTinMETRES,LONGITUDE,'
        'LATITUDE\n'
        'Tree,Lime,Tilia x europaea,46,14,-5.93015,54.59715\n'
        'Tree,Cherry,Prunus avium,20,7,-5.93035,54.59725\n',
        [('lime', 14.0, 0.46), ('cherry', 7.0, 0.2)],
    ),
    'Ulm': (
        'Koordinaten_X_Y;Koordinate_Y;Baumart;Baumart_botanisch;Baumhöhe_(aktuell);'
        'Stammdurchm_(aktuell)\n'
        '573800,1;5361700,2;Spitzahorn;Acer platanoides;12;35\n'
        '573810,1;5361704,2;Schwarzkiefer;Pinus nigra;16;40\n',
        [('maple', 12.0, 0.35), ('pine', 16.0, 0.4)],
    ),
    'Grand Junction': (
        'X,Y,TRG_GENUS,TRG_SPECIES,TRG_COMMON,TRG_DIA,TRG_HEIGHT\n'
        '-108.550612,39.063912,Fraxinus,pennsylvanica,"Ash, Green",14,45\n'
        '-108.550731,39.064012,Gleditsia,triacanthos,"Honeylocust",9,30\n',
        [('ash', 13.716, 0.356), ('honey_locust', 9.144, 0.229)],
    ),
    'a plot in metres with few digits stays one': (
        'x,y,species,height,dbh\n12.25,3.5,oak,18,45\n30.5,8.75,oak,20,50\n',
        [('oak', 18.0, 0.45), ('oak', 20.0, 0.5)],
    ),
}  # fmt: skip


def read(folder: Path, text: str) -> Inventory:
    path = folder / 'trees.csv'
    path.write_text(text, encoding='utf-8')
    return inventory_of(inventory_table(path, read_head(path)))


@pytest.mark.parametrize('name', READ)
def test_it_is_read_as_it_is(name: str, tmp_path: Path) -> None:
    text, expected = READ[name]
    found = read(tmp_path, text)
    assert [found.wood[each].key for each in found.species] == [key for key, *_ in expected]
    for row, (_, height, diameter) in enumerate(expected):
        assert found.is_height_found[row] == (height is None)
        assert height is None or found.height[row] == pytest.approx(height, rel=1e-3)
        assert np.isnan(found.diameter[row]) == (diameter is None)
        assert diameter is None or found.diameter[row] == pytest.approx(diameter, rel=5e-3)
    # Neighbours in a street, on a map or in degrees.
    step = np.hypot(np.diff(found.x), np.diff(found.y))
    assert step.min() > 3.0
    assert step.max() < 30.0


def test_degrees_in_x_and_y_are_said(tmp_path: Path) -> None:
    text, _ = READ['Washington']
    notes = ' '.join(read(tmp_path, text).notes)
    assert 'X and Y are taken as longitude and latitude' in notes
    assert 'DBH is taken as inches, as the trees stand in the United States' in notes


@pytest.mark.parametrize(
    ('text', 'message'),
    [
        (
            'codi,x_etrs89,y_etrs89,nom_cientific,categoria_arbrat\n1,430052,4583561,Ulmus,PRIMERA\n',
            'no column for the size (height, dbh or girth) among codi',
        ),
        (
            'CN,PLOT,SUBP,TREE,AZIMUTH,DIST,SPCD,DIA,HT\n1,10,1,1,45,12.3,131,8.1,55\n',
            'no column for the place (x and y, or latitude and longitude)',
        ),
        ('Name;Straße;Baujahr\na;b;1990\n', 'no column of an inventory'),
    ],
)
def test_a_missing_column_is_named(text: str, message: str, tmp_path: Path) -> None:
    with pytest.raises(FormatError) as error:
        read(tmp_path, text)
    assert message in str(error.value)
