# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Stem diameter by the age of a tree.

Polynomials that were fitted to street and park trees of known age, of one species and climate
region of the United States each (McPherson, van Doorn & Peper 2016, Urban tree database and
allometric equations, General Technical Report PSW-GTR-253; coefficients of the data archive
RDS-2016-0005, diameter in [cm]). Ages count from planting. Where a species was not
measured, the curve is that of a related one, which is named.
"""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.polynomial import Polynomial

from tree_sway.core.species import species_named
from tree_sway.errors import ParameterError
from tree_sway.tables import table_beside

OLDEST = 150
"""Age up to which curves are followed [years]."""


class StemGrowth(NamedTuple):
    """Diameter of a stem by age, for the species and region where it was measured."""

    diameters: tuple[float, ...]
    """Diameter at breast height at each whole age from 0 on [m]."""
    measured: str
    region: str

    @property
    def oldest(self) -> int:
        """Age up to which the curve grows and was measured [years]."""
        return len(self.diameters) - 1


def stem_of_age(species: str, age: float) -> float:
    """
    Return the usual diameter of the stem of a planted tree of an age.

    Parameters
    ----------
    species
        Key of the species table, or another name of the species.
    age
        Years since planting, above 0.

    Returns
    -------
    float
        Diameter at breast height in [m].

    Raises
    ------
    SpeciesError
        If the species is unknown.
    ParameterError
        If there is no curve for the species, or it does not reach the age.

    """
    key = species_named(species).key
    curve = stem_growth().get(key)
    if curve is None:
        known = ', '.join(stem_growth())
        what = f"no curve of growth for '{key}'"
        raise ParameterError(what, where='age', cure=f'leave age out, or take one of {known}')
    if not 0.0 < age <= curve.oldest:
        what = f'{age:g} years: {curve.measured} was measured up to {curve.oldest}'
        raise ParameterError(what, where='age', cure=f'give above 0, up to {curve.oldest} years')
    return float(np.interp(age, np.arange(curve.oldest + 1), curve.diameters))


@cache
def stem_growth() -> dict[str, StemGrowth]:
    """Return the curves of all species that have one, by the key of the species."""
    ages = np.arange(OLDEST + 1)
    curves = {}
    for row in table_beside(__file__, 'stem_by_age.csv'):
        diameters = Polynomial([row['c0'], row['c1'], row['c2'], row['c3']])(ages)
        # A fit may turn or leave the range of its trees: it is followed to there.
        ends = (np.diff(diameters) <= 0.0) | (diameters[1:] > row['largest'])
        n_ages = int(np.argmax(ends)) + 1 if ends.any() else ages.size
        in_metres = tuple(float(each) for each in 0.01 * diameters[:n_ages])
        curves[row['key']] = StemGrowth(in_metres, row['measured'], row['region'])
    return curves
