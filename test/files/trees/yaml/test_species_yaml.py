# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
from pathlib import Path

import pytest

from tree_sway.commands import cli
from tree_sway.core.tree.species import species_keys, species_named
from tree_sway.errors import FormatError, SpeciesError
from tree_sway.files.trees.source import open_scene, open_tree
from tree_sway.files.trees.yaml.species_yaml import open_species, parse_species

ELM = 'name: elm\nspecies: ash\nwood: {modulus: 7.2e9, damping_bare: .03}\n'


def test_a_key_is_the_tables_entry():
    for key in species_keys():
        assert open_species(key) is species_named(key)
    with pytest.raises(SpeciesError, match="unknown species 'elm'"):
        open_species('elm')


def test_a_file_replaces_what_it_says(tmp_path):
    path = tmp_path / 'elm.yaml'
    path.write_text(ELM)
    elm, ash = open_species(path), species_named('ash')
    assert (elm.title, elm.key, elm.modulus, elm.damping_bare) == ('elm', 'ash', 7.2e9, 0.03)
    assert (elm.density, elm.drag_exponent) == (ash.density, ash.drag_exponent)


@pytest.mark.parametrize(
    ('text', 'message'),
    [
        ('', 'empty'),
        ('name: elm', "the file has no 'species'; add 'species'"),
        ('species: elm', "elm.yaml:1: unknown species 'elm'"),
        (
            'species: ash\nwood: {modulus: soft}',
            r"elm.yaml:2: wood.modulus is 'soft'; give a number",
        ),
        (
            'species: ash\nwod: {}',
            "elm.yaml:2: unknown key 'wod' in the file; did you mean 'wood'",
        ),
        ('species: ash\nbranches: []', "unknown key 'branches'"),
    ],
)
def test_what_is_wrong_has_a_line(text, message):
    with pytest.raises((FormatError, SpeciesError), match=message):
        parse_species(text, 'elm.yaml')


def test_a_missing_file_is_named():
    with pytest.raises(
        SpeciesError, match=r"no species file 'elm\.yaml'; give a file, or one of: alder"
    ):
        open_species('elm.yaml')


def test_it_is_taken_wherever_a_species_is(tmp_path):
    (tmp_path / 'elm.yaml').write_text(ELM)
    (tmp_path / 'glade.yaml').write_text(
        'trees:\n- {name: a, tree: benjamina, species: elm.yaml}\n'
    )
    (tree,) = open_scene(tmp_path / 'glade.yaml').trees
    assert (tree.species.modulus, tree.tree.species) == (7.2e9, 'ash')
    grown = tmp_path / 'grown.yaml'
    species = str(tmp_path / 'elm.yaml')
    assert cli.main(['grow', '--species', species, '--height', '3', '-o', str(grown)]) == 0
    assert open_tree(grown).species.modulus == 7.2e9
    out = tmp_path / 'out.yaml'
    seedling = str(Path(__file__).parents[2] / 'data' / 'seedling.yaml')
    assert cli.main(['convert', seedling, '--species', species, '-o', str(out)]) == 0
    assert open_tree(out).species.damping_bare == 0.03
