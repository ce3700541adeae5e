# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Rows of inventories that are no living tree, lists that are no inventory, and their names."""

from __future__ import annotations

from pathlib import Path

import pytest

from tree_sway.errors import FormatError
from tree_sway.files.scenes.inventory.inventory_file import inventory_table
from tree_sway.files.scenes.inventory.no_trees import said_of_none
from tree_sway.files.scenes.inventory.read_inventory import Inventory, inventory_of
from tree_sway.files.text_file import decoded, read_head
from tree_sway.files.trees.source import open_scene


def read(folder: Path, text: str, page: str = 'utf-8') -> Inventory:
    path = folder / 'trees.csv'
    path.write_bytes(text.encode(page))
    return inventory_of(inventory_table(path, read_head(path)), needs_place=False)


@pytest.mark.parametrize(
    ('text', 'says'),
    [
        ('Souche', 'only a stump'),
        ('STUMP 20-30 in', 'only a stump'),
        ('Tocón', 'only a stump'),
        ('Emplacement libre', 'without a tree'),
        ('Vacant Tree Pit (planned: Betula nana)', 'without a tree'),
        ('Site - Vacant', 'without a tree'),
        ('Jungbaum wird gepflanzt', 'without a tree'),
        ('ALCORQUE VACIO', 'without a tree'),
        ('Dead', 'dead or gone'),
        ('Dead, broken bole', 'dead or gone'),
        ('Baum gefällt am 3.2.2020', 'dead or gone'),
        ('abbattuta', 'dead or gone'),
        ('odstraněný', 'dead or gone'),
        ('Hedgerow, mixed', 'of a group or hedge'),
        ('Privet hedge', 'of a group or hedge'),
        ('Hainbuchenhecke', 'of a group or hedge'),
        ('Tree(s)', 'unknown'),
        ('n/a', 'unknown'),
        ('Baumart unbekannt', 'unknown'),
        ('Mixed broadleaf', 'unknown'),
        ('Mixed: hawthorn, elder', ''),
        ('Hedge maple', ''),
        ('Unknown (Quercus)', ''),
        ('Unknown maple', ''),
        ('Vacant lot', ''),
        ('Fair, some dead branches', ''),
        ('Tote Äste', ''),
        ('0-25% dead', ''),
        ('Tree of heaven', ''),
        ('A', ''),
        ('12', ''),
        ('', ''),
    ],
)
def test_what_a_cell_says_of_no_tree(text: str, says: str) -> None:
    assert said_of_none(text) == says


def test_rows_without_a_tree_are_left_out_with_the_reason(tmp_path: Path) -> None:
    inventory = read(
        tmp_path,
        'id,genre,hauteur (m),circonference (cm),lon,lat\n'
        '1,Tilia,12,90,4.85,45.75\n2,Souche,0,60,4.86,45.75\n'
        '3,Emplacement libre,,40,4.87,45.75\n4,Inconnu,9,70,4.88,45.75\n',
    )
    assert inventory.names == ('1', '4')
    assert inventory.species == ('Tilia', '')
    why = "2 rows are left out: 1 only a stump, 1 without a tree; line 3: genre is 'Souche'"
    assert why in inventory.notes
    assert not any('not in the table' in note for note in inventory.notes)


SCHEDULE = (
    'Tree ref.,Species,Height (m),Stem dia. (mm),Physiological condition\n'
    'T1,Field Maple (Acer campestre),9,310,Good\n'
    'T2,Common Oak (Quercus robur),17,820,"Fair, dead wood"\n'
    'T3,Ash (Fraxinus excelsior),14,400,Dead\n'
    'G1,Hawthorn,4.5,80 avg,Good\nH1,Privet hedge,1.8,,Good\n'
)


def test_groups_hedges_and_dead_trees_of_a_schedule_are_left_out(tmp_path: Path) -> None:
    inventory = read(tmp_path, SCHEDULE)
    assert inventory.names == ('T1', 'T2')
    assert [inventory.wood[each].key for each in inventory.species] == ['maple', 'oak']
    (why,) = (note for note in inventory.notes if 'left out' in note)
    assert '3 rows are left out: 2 of a group or hedge, 1 dead or gone' in why
    assert not any('cannot be read' in note for note in inventory.notes)


def test_letters_of_other_numbers_are_no_groups(tmp_path: Path) -> None:
    rows = SCHEDULE.replace('G1', 'B1').replace('Privet hedge,1.8,,', 'Privet,1.8,20,')
    assert 'B1' in read(tmp_path, rows).names


def test_a_scene_of_trees_without_places_names_what_reads_them(tmp_path: Path) -> None:
    (tmp_path / 'schedule.csv').write_text(SCHEDULE)
    with pytest.raises(FormatError, match=r'no column for the place.*tree-sway risk reads trees'):
        open_scene(tmp_path / 'schedule.csv')


def test_a_row_of_several_trees_is_told_and_one_of_none_left_out(tmp_path: Path) -> None:
    inventory = read(
        tmp_path,
        'Identifier,Number Of Trees,Species,Height,DBH,Longitude,Latitude\n'
        '07,1,Quercus robur,12,40,-0.13,51.5\n08,6,Tilia,8,14,-0.14,51.5\n'
        '09,0,Tilia,8,14,-0.15,51.5\n',
    )
    assert inventory.names == ('07', '08')
    told = 'rows for several trees by Number Of Trees: 1, line 3 for 6; each is taken as one tree'
    assert told in inventory.notes
    assert "1 row is left out: 1 without a tree; line 4: Number Of Trees is '0'" in inventory.notes


def test_names_are_of_the_column_that_tells_trees_apart(tmp_path: Path) -> None:
    head = 'BaumNr,BAUM_ID,Baumart,Baumhöhe,Stammumfang,x,y\n'
    rows = [f'{n % 3},{800 + n},Linde,12,90,{n}.5,{2 * n}.5' for n in range(6)]
    assert read(tmp_path, head + '\n'.join(rows)).names == tuple(str(800 + n) for n in range(6))
    one_twice = [f'{max(n, 1)},{800 + n},Linde,12,90,{n}.5,{2 * n}.5' for n in range(30)]
    assert read(tmp_path, head + '\n'.join(one_twice)).names[:3] == ('1', '1-2', '2')


def test_a_list_of_species_is_no_inventory(tmp_path: Path) -> None:
    head = 'Botanischer Name;Höhe (m);Breite (m)\n'
    listed = 'Acer campestre;10-15 (20);8\nTilia cordata;-15;6\nUlmus;12-15;4\n'
    with pytest.raises(FormatError, match=r"a list of species and no inventory.*'10-15 \(20\)'"):
        read(tmp_path, head + listed)
    assert len(read(tmp_path, head + listed + 'Quercus robur;21;9\n').names) == 2


def test_a_row_of_names_and_numbers_below_the_header_is_no_header(tmp_path: Path) -> None:
    text = (
        'reference,equation,taxa,lat,long,most,least\n'
        'a,x,Pinus,47.1,8.2,1,2\nb,y,Height,DBH,Genus,3,500\n'
    )
    with pytest.raises(FormatError, match=r'no column for the species.*reference, equation, taxa'):
        read(tmp_path, text)


@pytest.mark.parametrize(
    ('name', 'page'),
    [
        ('楓香', 'big5'),
        ('银杏', 'gb18030'),
        ('느티나무', 'cp949'),
        ('クロマツ', 'cp932'),
        ('松樹', 'cp932'),
    ],
)
def test_names_of_pages_of_two_bytes_are_read(tmp_path: Path, name: str, page: str) -> None:
    text = f'id,species,height,dbh,x,y\n1,{name},12,30,1.5,2.5\n2,oak,9,20,4.5,5.5\n'
    assert read(tmp_path, text, page).species[0] == name


@pytest.mark.parametrize(
    'text', ['Smith’s, Jones’s “oak”', '°C,µg/m³,°C', 'GRÖSSE ÄÖÜ äöüß', 'ação ções', '«àéè» ÀÉÈ']
)
def test_western_text_is_of_no_page_of_two_bytes(text: str) -> None:
    assert decoded(text.encode('cp1252')) == text


@pytest.mark.parametrize(
    'text',
    [
        'pařez;zdravotní stav;odumřelý',
        'wysokość;klon pospolity;dąb szypułkowy',
        'výška;šířka;buk lesní',
    ],
)
def test_czech_and_polish_text_is_of_page_1250(text: str) -> None:
    assert decoded(text.encode('cp1250')) == text


@pytest.mark.parametrize('text', ['Højde;Træart;Bøgh Šimon', 'cœur, più, lì', 'm³/s;¿Qué?;año'])
def test_other_text_is_of_page_1252(text: str) -> None:
    assert decoded(text.encode('cp1252')) == text


@pytest.mark.parametrize(
    ('column', 'living', 'gone'),
    [
        ('HISTORY', '1', '6'),
        ('RETIREDDT', '', '2021/03/04'),
        ('ASSET_SUBTYPE', 'TREE', 'STUMP'),
        ('plantStatus', 'Live, broken bole', 'Dead, broken bole'),
        ('TreeStatus', 'živý', 'suchý'),
    ],
)
def test_columns_of_states_tell_what_is_gone(
    tmp_path: Path, column: str, living: str, gone: str
) -> None:
    head = f'id,species,dbh,height,x,y,{column}\n'
    rows = f'1,oak,30,12,1.5,2.5,"{living}"\n2,oak,30,12,8.5,2.5,"{gone}"\n'
    assert read(tmp_path, head + rows).names == ('1',)


def test_a_genus_in_its_own_column_does_not_hide_the_species(tmp_path: Path) -> None:
    inventory = read(
        tmp_path,
        'SCI_NM,CMMN_NM,GENUS_NAME,DBH,X,Y\nAcer rubrum,Red maple,Acer,9,1.5,2.5\n'
        ',,Quercus,12,8.5,2.5\n',
    )
    assert inventory.species == ('Acer rubrum', 'Quercus')


def test_stems_in_millimetres_are_told_by_heights(tmp_path: Path) -> None:
    inventory = read(
        tmp_path, 'Tag,Species,D1,Height,X,Y\n1,Fagus,318,28,2.5,3.5\n2,Fagus,118,15,7.5,3.9\n'
    )
    assert inventory.diameter == pytest.approx([0.318, 0.118])
    assert 'D1 is taken as mm, by height over it' in inventory.notes


@pytest.mark.parametrize(
    ('column', 'cells', 'why'),
    [
        ('STADE_DEVELOPPEMENT', 'Jeune Mort Adulte', 'dead or gone'),
        ('Entwicklungsphase', 'Reife abgestorben Jugend', 'dead or gone'),
        ('stadio di sviluppo', 'adulto morto giovane', 'dead or gone'),
        ('Vigour class', 'good stump fair', 'only a stump'),
        ('SOUCHE', 'Non Oui Non', 'dead or gone'),
        ('Stubbe', 'nej ja nej', 'dead or gone'),
        ('is_stump', '0 1 0', 'dead or gone'),
        ('Standing dead (Y/N)', 'n Y n', 'dead or gone'),
        ('mort', 'non oui non', 'dead or gone'),
        ('Gefällt', 'nein ja nein', 'dead or gone'),
        ('Suchý', 'ne ano ne', 'dead or gone'),
        ('vacant', 'false true false', 'dead or gone'),
        ('Alive', 'Y N Y', 'dead or gone'),
        ('Stump present', 'No Yes No', 'dead or gone'),
        ('Live/Dead', 'L D L', 'dead or gone'),
        ('Mortality', 'alive dead alive', 'dead or gone'),
        ('Removed', '- 2024-03-01 -', 'dead or gone'),
    ],
)
def test_a_column_of_the_dead_tells_them(
    tmp_path: Path, column: str, cells: str, why: str
) -> None:
    rows = [f'T{i},{9 * i},0,Tilia,12,{cell.strip("-")}' for i, cell in enumerate(cells.split())]
    trees = read(tmp_path, '\n'.join([f'id,x,y,species,height,{column}', *rows]) + '\n')
    assert trees.names == ('T0', 'T2')
    assert any(note.startswith(f'1 row is left out: 1 {why}; line 3') for note in trees.notes)


@pytest.mark.parametrize(
    ('column', 'cells'),
    [
        ('stump_height', '0.3 1 0.5'),
        ('Stock', '3 1 2'),
        ('TOT', '3 1 2'),
        ('tot', '1 1 1'),
        ('v.tot', '0.51237 0.2016 1.0'),
        ('dead', '0.1234 0.2019 0.3'),
        ('Totholz', 'nein ja nein'),
        ('dead_wood', 'no yes no'),
        ('hedge', 'no yes no'),
        ('group', 'no yes no'),
    ],
)
def test_other_columns_do_not(tmp_path: Path, column: str, cells: str) -> None:
    rows = [f'T{i},{9 * i},0,Tilia,12,{cell}' for i, cell in enumerate(cells.split())]
    trees = read(tmp_path, '\n'.join([f'id,x,y,species,height,{column}', *rows]) + '\n')
    assert trees.names == ('T0', 'T1', 'T2')
