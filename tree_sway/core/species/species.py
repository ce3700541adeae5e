# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Species by name; a new species is one row of ``species.csv``.

Modulus and density are of green wood: ForestGALES species tables, the BIOMASS wood density table
and the field table of Jackson et al. (2019). Maple (mean of sugar and red maple), lime (American
basswood), willow (black willow), poplar (eastern cottonwood), larch (western larch), fir (mean of
grand and Pacific silver fir), alder (red alder), cherry (black cherry), plane (American sycamore)
and eucalyptus (jarrah) are by tables 5-3 and 5-5 of the Wood Handbook (Forest Products Laboratory,
2010), their density the basic one times one plus the moisture of its table 4-1: other members of a
genus may differ by a quarter. Drag in leaf is C U^-N between 4 and 20 m/s: Mayhead (1973) for
conifers, Vollsinger et al. (2005) for broadleaves. Where no crown was measured, a broadleaf has
the mean of the three measured ones and a conifer the drag of spruce. The modulus of rupture is of
small clear specimens of green wood: Lavers (1983, The strength properties of timber) for European
trees, tables 5-3 and 5-5 of the Wood Handbook for the others. Diameters of twigs are means of the
species or of its genus in the table of Morales & MacFarlane (2024, Forestry; R package rTwig 1.4):
Thuja for goldcrest, its moderately slender twigs for broadleaf, Douglas-fir and alder, its slender
ones for benjamina, willow and eucalyptus, spruces for conifer. Entries marked as estimates are not
measured. Sources of leaves are in `leaf_traits`. Besides their keys, species have names: genus,
Latin names, names in a dozen languages, abbreviations.

Trees of streets: elm (American elm), hackberry, honey locust, robinia (black locust), sweetgum,
tulip tree (yellow-poplar), chestnut (American chestnut), magnolia (southern magnolia), red and
silver maple are by the same two tables of the Wood Handbook. No table of green wood has the
others, which are marked as estimates: horse chestnut, hornbeam, pear, apple and tree of heaven are
by the Wood Database (Meier), ginkgo by Cheng (1992, Wood of China), all of dry wood, times 0.80 in
modulus and 0.58 in rupture, the mean ratios of green to dry hardwoods in table 5-3, and with a
moisture of 80 %; pagoda tree has the modulus of the Stuttgart catalogue (Wessolly & Erb 1998);
zelkova has the wood of elm, rowan and hawthorn that of pear, hazel that of birch, of their
families. They have the habit of an average broadleaf.
"""

from __future__ import annotations

from dataclasses import fields
import math
import re
from typing import Any
import unicodedata

from tree_sway.core.species.foliage_traits import LeafTraits
from tree_sway.core.species.look import Look
from tree_sway.core.species.wood import Species
from tree_sway.errors import nearest, SpeciesError
from tree_sway.tables import table_beside

__all__ = ['Species']

_CONIFER_DAMPING = 0.08
"""
Damping ratio of conifers, and of plants in pots, in leaf beside the drag of the air [-].

It is that of Douglas-firs that no neighbour touched (Moore & Maguire 2005, Trees 19, 363-373).
"""

_ROWS = {row['key']: row for row in table_beside(__file__, 'species.csv')}

NAMES: dict[str, list[str]] = {key: row.pop('names').split(', ') for key, row in _ROWS.items()}
"""Other names of every species, by its key."""


def _species(row: dict[str, Any]) -> Species:
    leaves = LeafTraits(**{each.name: row.pop(each.name) for each in fields(LeafTraits)})
    look = {each.name: row.pop(each.name) for each in fields(Look)}
    if look['autumn'] == 'none':
        look['autumn'] = None
    if row['habit'] != 'broadleaf':
        row['damping_in_leaf'] = _CONIFER_DAMPING
    return Species(**row, leaves=leaves, look=Look(**look))


SPECIES = {key: _species(row) for key, row in _ROWS.items()}
"""Every species by its key."""

_UMLAUTS = str.maketrans({'ä': 'ae', 'ö': 'oe', 'ü': 'ue', 'ß': 'ss', 'ø': 'o', 'ł': 'l'})
_SHORTEST_END = 4
"""Letters of the shortest name that a longer word may end with, as Winterlinde with linde."""


def _plain(name: str) -> str:
    """Words of a name in lower case without accents; umlauts as ae, oe and ue."""
    lower = unicodedata.normalize('NFC', name).lower().translate(_UMLAUTS)
    letters = unicodedata.normalize('NFKD', lower)
    bare = ''.join(letter for letter in letters if not unicodedata.combining(letter))
    return ' '.join(re.findall(r'\w+', bare.replace('_', ' ')))


_KEYS = {key.replace('_', ' '): key for key in SPECIES}
_KEYS |= {_plain(name): key for key, names in NAMES.items() for name in names}
_SUGGESTED = [*(name for name in _KEYS if len(name) > 3), *SPECIES]
"""Keys and names to suggest; an abbreviation is near to too many words."""
_ENDS = sorted((name for name in _KEYS if len(name) >= _SHORTEST_END), key=len, reverse=True)
_GENERA = {'sophora', *(names[0].split()[0] for names in NAMES.values())}
"""Genera of the table: a name that begins with one is Latin, and counts before others."""
_IN_BRACKETS = re.compile(r'[(\[]([^)\]]*)[)\]]?')
_LISTED = re.compile(r'[/&+;]|,.*,')
_BETWEEN = re.compile('[,/&+;:]')
_FILE = re.compile(r'\.(ya?ml|json|csv)\s*$', re.IGNORECASE)
_CONIFEROUS = re.compile(
    r'conifer|nadel|needle|(c|z)[iy]pre|ceda?r|zeder|yew|eibe|hemlock|redwood|tasso|'
    r'(fir|pine|spruce|if)\b'
)


def species_named(name: str) -> Species:
    """
    Look a species up by its key, a name or its genus, in any case of letters.

    A name in brackets counts as well, a Latin one first, as in ``Field maple (Acer campestre)``,
    and one that is turned round by a comma, as ``Chestnut, horse``.

    Raises
    ------
    SpeciesError
        If no species has that name, or it is that of a file; the error lists the species.

    """
    if not isinstance(name, str):
        what = f'a {type(name).__name__}, where the name of a species is expected'
        raise SpeciesError(what, cure="give it as 'oak'")
    if name in SPECIES:
        return SPECIES[name]
    if _FILE.search(name):
        cure = 'give the name of a species; only the option --species reads a file'
        raise SpeciesError(f"'{name}' is the name of a file", cure=cure)
    if _has_several(name):
        raise SpeciesError(f"several species in '{name}'", cure='give one')
    for reading in _readings(name):
        words = reading.split()
        # A first word alone is a genus; pin oak is no pine, though that is pin in French.
        is_genus = len(words) == 1 or (len(words[0]) >= _SHORTEST_END and not _has_noun(words))
        for known in (reading, ' '.join(words[:2]), *words[:is_genus]):
            if known in _KEYS:
                return SPECIES[_KEYS[known]]
    words = _plain(name).split()
    # Of two words, one may be right: the whole name is far from each known name.
    guesses = (nearest(each, _SUGGESTED) for each in (' '.join(words), *words))
    guess = next(filter(None, guesses), '')
    cure = f'{guess} use one of: {", ".join(sorted(SPECIES))}'.lstrip()
    raise SpeciesError(f"unknown species '{name}'", cure=cure)


def _readings(name: str) -> list[str]:
    """Plain names that a text has outside and inside brackets, Latin ones first."""
    around = _IN_BRACKETS.sub(' ', name)
    first, _, last = around.partition(',')
    readings = [_plain(each) for each in (f'{last} {first}', around, *_IN_BRACKETS.findall(name))]
    return sorted(filter(None, readings), key=lambda each: each.split()[0] not in _GENERA)


def _has_several(name: str) -> bool:
    """Whether a text lists trees of several species, as ``ash, oak, field maple``."""
    listed = map(_plain, _BETWEEN.split(name) if _LISTED.search(name) else ())
    keys = (_KEYS.get(each) or _KEYS.get(each.rpartition(' ')[2]) for each in listed)
    return len({*filter(None, keys)}) > 1


def _has_noun(words: list[str]) -> bool:
    """Whether a name ends with that of a tree which the first of two words is not: willow oak."""
    return len(words) == 2 and words[0] not in _GENERA and words[1] in _KEYS


_LIKE = {1: 1.0, 2: 1.0, 3: 0.65, 4: 0.65}
"""Least share of common letters of a guess for a short name; two letters are a code."""
_LIKE_LONG = 0.8


def species_like(name: str) -> tuple[Species, str]:
    """
    Look a species up, an unknown one by its last word, as a silver birch as a birch.

    A longer word counts by its end, as Winterlinde by linde. Any other name is taken as a conifer
    or a broadleaf of unknown species.

    Returns
    -------
    Species, str
        The species, and the assumption made; empty without one.

    """
    try:
        return species_named(name), ''
    except SpeciesError:
        pass
    plain = _plain(name)
    for words in map(str.split, _readings(name) if not _has_several(name) else ()):
        ends = (each for each in _ENDS if words[-1].endswith(each))
        # Foresters' abbreviations of two letters, as Fi for spruce, are whole names alone.
        first, last = (each if len(each) > 2 else '' for each in (words[0], words[-1]))
        end = last if last in _KEYS else next(ends, first if first in _KEYS else '')
        if end:
            group = SPECIES[_KEYS[end]]
            return group, f"'{name[:40]}' is taken as {group.title}"
    group = SPECIES['conifer' if _CONIFEROUS.search(plain) else 'broadleaf']
    note = f"'{name[:40]}' is not in the table: taken as {group.title}"
    guess = nearest(plain, _SUGGESTED, _LIKE.get(len(plain), _LIKE_LONG))
    return group, '; '.join(filter(None, (note, guess)))


def species_keys() -> tuple[str, ...]:
    """Keys of every species in the table."""
    return tuple(SPECIES)


def look_of(key: str) -> Look:
    """Look of a species; that of an average broadleaf if it is unknown."""
    return SPECIES[key].look if key in SPECIES else Look()


ROOT_MOMENT = 120.0
"""
Moment at which roots fail over the mass of the stem in [N m/kg].

Conifers fall at a moment proportional to the mass of their stem (winching tests on near 2,000
trees: Nicoll et al. 2006): of 77 N m/kg for western hemlock, 95 for redcedar, 119 for hybrid
spruce, 146 for lodgepole pine (Byrne 2005). That broadleaves are like conifers is assumed.
"""


def typical_root_stiffness(stem_mass: float) -> float:
    """
    Stiffness against tilting in [N m/rad] of the roots of a tree with a stem of a mass [kg].

    Trees tilt by a quarter of a degree at 40 % of the moment at which their roots fail (280 trees:
    Detter, Rust & Krisans 2023, Forests 14, 533). Soils differ by a factor of two.
    """
    return 0.4 * ROOT_MOMENT * stem_mass / math.radians(0.25)


def leaf_traits(key: str) -> LeafTraits:
    """Leaves of a species; those of an average broadleaf if it is unknown."""
    return SPECIES[key].leaves if key in SPECIES else LeafTraits()
