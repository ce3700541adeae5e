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
from tree_sway.files.table_file import parse_table
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
    'Alessandria': (
        'Identificativo;Tipologia;Essenza;RangeAltezza;RangeDiametroFusto;CoordX;CoordY\n'
        '1;Albero;Tilia cordata;2) 10 - 16m;2) 20cm< & <=50cm;1470210.4;4972811.7\n'
        '2;Ceppaia;Tilia cordata;;3) 50cm< & <=100cm;1470215.4;4972811.7\n'
        '3;Albero;Fagus sylvatica;1) < 10m;1) <= 20cm;1470220.4;4972811.7\n',
        [('lime', 13.0, 0.35), ('beech', 10.0, 0.2)],
    ),
    'LiDAR360': (
        'TreeID,TreeLocationX,TreeLocationY,TreeHeight,DBH,CrownDiameter,species\n'
        '1,432613.3,5286463.6,22.8,0.49,5.7,beech\n2,432617.6,5286457.7,17.8,0.289,3.3,oak\n',
        [('beech', 22.8, 0.49), ('oak', 17.8, 0.289)],
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
    'Calgary, a point in one column, epithets that are not known': (
        'TREE_ASSET_CD,COMMON_NAME,GENUS,SPECIES,CULTIVAR,DBH_CM,POINT\n'
        'A1,"SPRUCE, COLORADO",PICEA,PUNGENS,STANDARD,22,POINT (-114.1 51.05)\n'
        'A2,POPLAR SPECIES,POPULUS,SP.,,40,POINT (-114.1001 51.05)\n',
        [('spruce', None, 0.22), ('poplar', None, 0.4)],
    ),
    'Dublin, Irish Transverse Mercator': (
        'Tree Number;Tree_Species_English;Tree_Species_Latin;Height_M;Trunk_Dia_MM;X_ITM;Y_ITM\n'
        '1;Sycamore;Acer pseudoplatanus;14;480;715800.1;734100.2\n'
        '2;Ash;Fraxinus excelsior;12;360;715808.1;734101.2\n',
        [('sycamore', 14.0, 0.48), ('ash', 12.0, 0.36)],
    ),
    'Adelaide, degrees of four digits in x and y': (
        'OBJECTID,Botanical_Name,Height__m_,DBH__mm_,Canopy_Spread__m_,x,y\n'
        '1,Jacaranda mimosifolia,9,310,8,138.6011,-34.9211\n'
        '2,Eucalyptus camaldulensis,21,910,18,138.6012,-34.9212\n',
        [('broadleaf', 9.0, 0.31), ('eucalyptus', 21.0, 0.91)],
    ),
    'Bologna': (
        'Geo Point;Specie arborea;Genere;Altezza (m);Diametro fusto (cm)\n'
        '44.4938,11.3387;Celtis australis;Celtis;9;45\n'
        '44.4939,11.3388;Tilia cordata;Tilia;14;38\n',
        [('hackberry', 9.0, 0.45), ('lime', 14.0, 0.38)],
    ),
    'Leipzig, Rechtswert and Hochwert by their letters': (
        'standortnr;baumart_lat;baumart_dt;stammdurchmesser_cm;baumhoehe_m;rw;hw\n'
        '1;Quercus robur;Stiel-Eiche;55;16;317500,2;5690100,3\n'
        '2;Fraxinus excelsior;Gemeine Esche;45;15;317507,2;5690100,3\n',
        [('oak', 16.0, 0.55), ('ash', 15.0, 0.45)],
    ),
    'Prague, a negative grid': (
        'X;Y;OBJECTID;DRUH_CESKY;DRUH_LAT;VYSKA;OBVOD_KMENE\n'
        '-742100,2;-1043100,1;1;lípa srdčitá;Tilia cordata;12;110\n'
        '-742110,2;-1043101,1;2;javor mléč;Acer platanoides;9;75\n',
        [('lime', 12.0, 0.35), ('maple', 9.0, 0.239)],
    ),
    'Mexico': (
        'no,ESPECIE,NOMBRE COMÚN,ALTURA (M),DAP (CM),COORDENADA X,COORDENADA Y\n'
        '1,Jacaranda mimosifolia,Jacaranda,9,31,485100,2147000\n'
        '2,Fraxinus uhdei,Fresno,14,45,485110,2147002\n',
        [('broadleaf', 9.0, 0.31), ('ash', 14.0, 0.45)],
    ),
    'Oslo': (
        'Tre-ID;Art norsk;Art latin;Høyde (m);Stammeomkrets (cm);Øst;Nord\n'
        '1;Parklind;Tilia x europaea;14;126;597900;6643100\n'
        '2;Hengebjørk;Betula pendula;12;94;597907;6643100\n',
        [('lime', 14.0, 0.401), ('birch', 12.0, 0.299)],
    ),
    'Hong Kong, a species known by its cells': (
        'Tree ID,Tree Species 樹木品種,Tree Height(m) 樹高(米),DBH(mm) 樹幹直徑,Easting,Northing\n'
        '1,Celtis sinensis 朴樹,11,550,835100,818100\n'
        '2,Ficus microcarpa 細葉榕,15,800,835120,818100\n',
        [('hackberry', 11.0, 0.55), ('benjamina', 15.0, 0.8)],
    ),
    'Portland, degrees of four digits, inches and feet': (
        'X,Y,OBJECTID,Species,DBH,Condition,Scientific,Common,TreeHeight\n'
        '-122.6600,45.5200,1,ACPL,12.5,Good,Acer platanoides,Norway maple,40\n'
        '-122.6601,45.5201,2,PSME,24.0,Good,Pseudotsuga menziesii,Douglas-fir,85\n',
        [('maple', 12.192, 0.318), ('douglas_fir', 25.908, 0.61)],
    ),
    'Christchurch, all in metres': (
        'TreeID,BotanicalName,CommonName,Height,StemDiameter,GirthSize,NZTMX,NZTMY\n'
        '1,Quercus robur,English oak,16,0.85,2.67,1570100.1,5180100.2\n'
        '2,Betula pendula,Silver birch,12,0.35,1.1,1570110.1,5180100.2\n',
        [('oak', 16.0, 0.85), ('birch', 12.0, 0.35)],
    ),
    'Lyon, decimal commas': (
        'essencefrancais;circonference_cm;hauteurtotale_m;hauteurfut_m;genre;espece;lon;lat\n'
        "Platane à feuilles d'érable;187;17;4;Platanus;acerifolia;4,8501;45,7501\n"
        'Micocoulier;93;11;3;Celtis;australis;4,8502;45,7502\n',
        [('plane', 17.0, 0.595), ('hackberry', 11.0, 0.296)],
    ),
    'Cologne of 2017, trunks of one or of several stems': (
        'PFLEGEOBJE;Objekttyp;Baum-Nr.;X_Koordina;Y_Koordina;STAMMVON;STAMMBIS;KRONE;HöHE;'
        'Gattung;Art;Sorte;DeutscherN\n'
        '900;6;20U;360450,2;5645800,1;0;45;8;14;Platanus;x acerifolia;;Platane\n'
        '901;6;21U;360460,2;5645805,1;30;60;10;18;Tilia;cordata;;Winterlinde\n',
        [('plane', 14.0, 0.45), ('lime', 18.0, 0.6)],
    ),
    'Cologne of 2020, a height without its umlaut': (
        'objekttyp;Baum_Nr;X_KOORDINA;Y_KOORDINA;STAMMVON;STAMMBIS;KRONE;H_HE;Gattung;Art\n'
        '6;20U;360450.2;5645800.1;0;45;8;14;Platanus;x acerifolia\n'
        '6;21U;360460.2;5645805.1;0;0;10;18;Tilia;cordata\n',
        [('plane', 14.0, 0.45), ('lime', 18.0, None)],
    ),
    'Heilbronn, girths in metres, a type of trees before their species': (
        'BAUM_NR,ORT,TYP,DEU_TEXT,WIS_TEXT,ST_UMFANG,KRONE_DM,X,Y\n'
        '1,Heilbronn,Laubbaum,Winterlinde,Tilia cordata,1.1,8,515000,5443000\n'
        '2,Heilbronn,Nadelbaum,Waldkiefer,Pinus sylvestris,0.9,5,515010,5443004\n',
        [('lime', None, 0.35), ('pine', None, 0.286)],
    ),
    'a type of trees before a column of species with a name of its own': (
        'TYP,Bezeichnung,BHD,H,X,Y\n'
        'Laubbaum,Winterlinde,35,14,515000,5443000\nNadelbaum,Kiefer,29,16,515010,5443004\n',
        [('lime', 14.0, 0.35), ('pine', 16.0, 0.29)],
    ),
    'Lisbon, PAP': (
        'OBJECTID,COD_SIG,ESPECIE_VA,NOME_VULGA,PAP,ALTURA,X,Y\n'
        '1,A1,Celtis australis,Lodão-bastardo,120,12,-9.1412,38.7112\n'
        '2,A2,Platanus x hispanica,Plátano,200,18,-9.1414,38.7113\n',
        [('hackberry', 12.0, 0.382), ('plane', 18.0, 0.637)],
    ),
    'The Hague, classes of height and diameter': (
        'BOOMSOORT_WETENSCHAPPELIJ,BOOMSOORT_NEDERLANDS,STAMDIAMETERKLASSE,'
        'BOOMHOOGTEKLASSE_ACTUEEL,LEEFTIJD,X,Y\n'
        'Tilia europaea,Hollandse linde,"0,3 tot 0,4 m.",12 tot 15 m.,40,81000,455000\n'
        'Quercus robur,Zomereik,"0,5 tot 1,0 m.",18 tot 24 m.,80,81010,455003\n',
        [('lime', 13.5, 0.35), ('oak', 21.0, 0.75)],
    ),
    'Divonne-les-Bains, a shapefile': (
        'id,genre,espece,classe_hau,circonfere,x,y\n'
        '1,Tilia,cordata,10 à 15 m,110,2490000,1135000\n'
        '2,Acer,platanoides,5 à 10 m,70,2490010,1135004\n',
        [('lime', 12.5, 0.35), ('maple', 7.5, 0.223)],
    ),
    'Prospect': (
        'Tree Number,Common Name,Tree Species,Tree Circumference,Tree Height,Latitude,Longitude\n'
        '1,Jacaranda,Jacaranda mimosifolia,95,8,-34.8812,138.5912\n'
        '2,White Ash,Fraxinus americana,70,6,-34.8813,138.5913\n',
        [('broadleaf', 8.0, 0.302), ('ash', 6.0, 0.223)],
    ),
    'Launceston, a shapefile': (
        'genusspeci,name,diametr_c,height_m,age,longitude,latitude\n'
        'Quercus robur,English oak,60,18,Mature,147.1234,-41.4321\n'
        'Ulmus procera,English elm,45,15,Mature,147.1236,-41.4322\n',
        [('oak', 18.0, 0.6), ('elm', 15.0, 0.45)],
    ),
    'Issy-les-Moulineaux': (
        'geo_point_2d;essence_com;essence_sci;circonferen;hauteur;classe_age\n'
        '48.8243,2.2701;Platane;Platanus x acerifolia;150;16;adulte\n'
        '48.8244,2.2703;Tilleul;Tilia tomentosa;90;10;adulte\n',
        [('plane', 16.0, 0.477), ('lime', 10.0, 0.286)],
    ),
    'Taipei': (
        'TreeID,Dist,Region,TreeType,Diameter,TreeHeight,SurveyDate,TWD97X,TWD97Y\n'
        'A1,中山區,路口,榕樹,45,9.5,2025-01-02,303100.1,2770100.2\n'
        'A2,中山區,路口,樟樹,32,8.0,2025-01-02,303110.1,2770104.2\n',
        [('broadleaf', 9.5, 0.45), ('broadleaf', 8.0, 0.32)],
    ),
    'Seoul': (
        '라벨,도로명,수목명,흉고직경(cm),수고(m),수관폭(m),경도,위도\n'
        '01,종로,은행나무,35,12,5,126.98120,37.57120\n'
        '02,종로,양버즘나무,45,15,7,126.98131,37.57121\n',
        [('ginkgo', 12.0, 0.35), ('plane', 15.0, 0.45)],
    ),
    'a survey by BS 5837': (
        'Tree No.,Species,Height (m),Stem dia. (mm),Branch spread N,Crown clearance (m),'
        'Life stage,BS category,Easting,Northing\n'
        'T1,Common oak,16,850,6,3,Mature,A1,531000,181000\n'
        'T2,Silver birch,12,320,3,2,Semi-mature,B2,531010,181006\n',
        [('oak', 16.0, 0.85), ('birch', 12.0, 0.32)],
    ),
    'a German survey, girths at breast height, heights estimated': (
        'Nr.;Baumart;Umfang in 1,3 m Höhe [cm];Höhe geschätzt [m];Krone Ø [m];'
        'Rechtswert (UTM);Hochwert (UTM)\n'
        '1;Stieleiche;250;18;14;391234;5821234\n2;Rotbuche;180;20;12;391244;5821240\n',
        [('oak', 18.0, 0.796), ('beech', 20.0, 0.573)],
    ),
    'Czech natural forests': (
        'STROM_ID;DREVINA;VYSKA;DELKA;VYCETNI_T1;X;Y\n'
        '1;smrk;32,5;;480;-742100,1;-1043100,2\n2;buk;28,0;;390;-742104,1;-1043103,2\n',
        [('spruce', 32.5, 0.48), ('beech', 28.0, 0.39)],
    ),
    'a plot in metres with few digits stays one': (
        'x,y,species,height,dbh\n12.250,3.500,oak,18,45\n30.500,8.750,oak,20,50\n',
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


@pytest.mark.parametrize(
    ('text', 'expected'),
    [
        ('SPCD,DIA,HT\n131,8.1,55\n131,9.4,58\n', [(16.764, 0.206), (17.678, 0.239)]),
        ('species,dbh,height\npine,7,24\nfir,14,45\n', [(7.315, 0.178), (13.716, 0.356)]),
        ('species,dbh,height\npine,18,24\nfir,34,28\n', [(24.0, 0.18), (28.0, 0.34)]),
    ],
)
def test_inches_and_feet_without_a_place_are_told_by_their_ratio(
    text: str, expected: list[tuple[float, float]]
) -> None:
    found = inventory_of(parse_table(text.splitlines(), 'trees.csv'), needs_place=False)
    sizes = np.column_stack([found.height, found.diameter])
    np.testing.assert_allclose(sizes, expected, rtol=5e-3)


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
            'CN,PLOT,SUBP,TREE,AZIMUTH,SPCD,DIA,HT\n1,10,1,1,45,131,8.1,55\n',
            'no column for the place (x and y, or latitude and longitude)',
        ),
        (
            'objid,strasse,baumnamelat,baumnamedeu,baumnummer,kronendurchmesser,geometry\n'
            '1,Allee,Acer platanoides,Spitzahorn,AL-1,8,POINT (2679000.1 1248000.2)\n',
            'no column for the size (height, dbh or girth) among objid',
        ),
        ('Name;Straße;Baujahr\na;b;1990\n', 'no column of an inventory'),
    ],
)
def test_a_missing_column_is_named(text: str, message: str, tmp_path: Path) -> None:
    with pytest.raises(FormatError) as error:
        read(tmp_path, text)
    assert message in str(error.value)
