# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Critical winds of the trees of an inventory: a row each, from the curves of its kind.

Trees of a kind have one species, and heights and stems near each other. Each is scaled to its own:
a tree as its kind, but larger, uses the same share in the same wind at its crown, which is taken
three quarters up, among neighbours that grow in proportion. Leaves, and with them the load, follow
the section d^2 of the stem (pipe model, `leaf_traits`; d^2 h U^2 in Hale et al. 2012); bare
branches are in proportion to d. The strength of the stem is that of its section modulus, d^3, and
that of roots is of the mass of the stem, d^2.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tree_sway.files.scenes import Inventory, kind_classes
from tree_sway.forest.cluster import cluster, DEADLINE, run_all
from tree_sway.forest.risk_kind import (
    compute_kind,
    KindResult,
    RiskKind,
    SeasonCurves,
)
from tree_sway.simulation import Exposure, root_band, wood_band

Row = dict[str, Any]

FASTEST = 80.0
"""Critical wind above which trees are not told apart [m/s]; no storm has such a mean wind."""
MOST_KINDS = 96
"""Number of kinds up to which trees are told apart, so that large inventories take minutes."""
_CROWN = 0.75
_KM_H = 3.6
_WIDER = 1.25


@dataclass(frozen=True)
class RiskWork:
    """Kinds of an inventory, and the rows of each."""

    inventory: Inventory
    kinds: dict[RiskKind, list[int]]


def risk_work(
    inventory: Inventory,
    seed: int = 0,
    most: int = MOST_KINDS,
    *,
    exposure: str = 'open',
    spacing: float | None = None,
) -> RiskWork:
    """
    Group the trees of an inventory into at most some kinds; more alike where they are few.

    Parameters
    ----------
    inventory
        The trees.
    seed
        Seed of grown trees and gusts.
    most
        Number of kinds, or two for each species if those are more, for each exposure.
    exposure
        Exposure of trees for which the inventory has none, one of `EXPOSURES`.
    spacing
        Mean distance between the trees of a stand in [m]; 0.18 of their height if None.

    """
    keys = [inventory.wood[each].key for each in inventory.species]
    exposures = [each or exposure for each in inventory.exposures]
    most = max(most, 2 * len(set(keys))) * len(set(exposures))
    heights = 1.5
    slendernesses = 1.2
    while True:
        classes = kind_classes(
            keys,
            inventory.height,
            inventory.diameter,
            heights=heights,
            slendernesses=slendernesses,
        )
        kinds: dict[RiskKind, list[int]] = {}
        sizes = zip(classes.height.tolist(), classes.slenderness.tolist(), strict=True)
        for row, (key, (height, slenderness)) in enumerate(zip(keys, sizes, strict=True)):
            where = exposures[row]
            apart = 0.0 if spacing is None or where == 'open' else spacing
            kind = RiskKind(key, height, slenderness, seed, where, apart)
            kinds.setdefault(kind, []).append(row)
        if len(kinds) <= most or heights > 20.0:
            return RiskWork(inventory, kinds)
        heights = heights * _WIDER
        slendernesses = slendernesses * _WIDER**0.5


def risk_rows(
    work: RiskWork, *, workers: int, scheduler: str | None = None, deadline: float = DEADLINE
) -> Iterator[tuple[int, list[Row]]]:
    """
    Yield the number of trees and their rows, a kind at a time, in the order that kinds are done.

    Errors are those of `cluster` and `run_all`.
    """
    pieces = [(f'kind {number}', (kind,)) for number, kind in enumerate(work.kinds)]
    with cluster(min(workers, max(len(pieces), 1)), scheduler) as (distributed, client):
        for result in run_all(
            distributed, client, compute_kind, pieces, is_result, deadline=deadline
        ):
            rows = rows_of_kind(work, result)
            yield len(rows), rows


def is_result(result: Any, kind: RiskKind) -> bool:
    """Whether a worker returned what was asked of it."""
    return isinstance(result, KindResult) and result.kind == kind


def rows_of_kind(work: RiskWork, result: KindResult) -> list[Row]:
    """Return the rows of all trees of a kind."""
    return [_row(work.inventory, row, result) for row in work.kinds[result.kind]]


def _row(inventory: Inventory, row: int, result: KindResult) -> Row:
    height = float(inventory.height[row])
    diameter = float(inventory.diameter[row])
    found: Row = {
        'name': inventory.names[row],
        'line': inventory.lines[row],
        'x [m]': round(float(inventory.x[row]), 3),
        'y [m]': round(float(inventory.y[row]), 3),
        'species': result.kind.species,
        'height [m]': round(height, 2),
        'diameter [m]': round(diameter, 3) if np.isfinite(diameter) else None,
        'exposure': result.kind.exposure,
    }
    winds = {
        (part, curves.in_leaf): _winds(curves, part, height, diameter, result)
        for curves in result.seasons
        for part in ('wood', 'roots')
    }
    first = min(winds, key=lambda each: winds[each][1]) if winds else None
    low, middle, high = winds[first] if first is not None else (None, None, None)
    exposure = result.exposure.scaled(height)
    top = float(exposure.profile().over_anemometer(np.array(height))) / exposure.at_ten_metres
    found |= {
        'critical_wind_10m [m/s]': _rounded(middle),
        'critical_wind_10m [km/h]': _rounded(middle, _KM_H),
        'critical_wind_top [m/s]': _rounded(middle, top),
        'critical_wind_top [km/h]': _rounded(middle, top * _KM_H),
        'low_80 [m/s]': _rounded(low),
        'high_80 [m/s]': _rounded(high),
        'limited_by': '' if first is None else f'{first[0]}, {_season(first[1])}',
    }
    for in_leaf in (True, False):
        for part in ('wood', 'roots'):
            name = f'{part}_{_season(in_leaf).replace(" ", "_")}'
            of_part = winds.get((part, in_leaf), (None, None, None))
            for what, value in zip(('_low_80', '', '_high_80'), of_part, strict=True):
                found[f'{name}{what} [m/s]'] = _rounded(value)
    found['assumed'] = '; '.join(_assumed(inventory, row, result, middle))
    return found


def _season(in_leaf: bool) -> str:
    return 'in leaf' if in_leaf else 'bare'


def _winds(
    curves: SeasonCurves, part: str, height: float, diameter: float, result: KindResult
) -> tuple[float, float, float]:
    """Critical wind at 10 m of wood or roots [m/s]: low, middle and high."""
    curve = curves.wood if part == 'wood' else curves.roots
    slenderness = height / diameter if np.isfinite(diameter) else result.slenderness
    load = 2.0 if curves.in_leaf else 1.0
    power = (3.0 if part == 'wood' else 2.0) - load
    more = (slenderness / result.slenderness) ** power
    own = result.exposure.scaled(height)
    scale = _at_crown(result.exposure.scaled(result.kind.height)) / _at_crown(own)
    scale *= own.at_ten_metres
    used = (wood_band if part == 'wood' else root_band)(in_leaf=curves.in_leaf)
    middle, high, low = (
        min(scale * curve.speed_of(1.0 / (each * more)), FASTEST) for each in used.tolist()
    )
    return low, middle, high


def _at_crown(exposure: Exposure) -> float:
    """Wind three quarters up a tree over the mean wind of its exposure [-]."""
    return float(exposure.profile().over_anemometer(np.array(_CROWN * exposure.height)))


def _rounded(value: float | None, factor: float = 1.0) -> float | None:
    return None if value is None else round(factor * value, 2)


def _assumed(
    inventory: Inventory, row: int, result: KindResult, critical: float | None
) -> Sequence[str]:
    species = inventory.species[row]
    said = []
    if result.error:
        said.append(f'not computed: {result.error}')
    if not species:
        said.append('no species: a broadleaf of no known species')
    elif inventory.wood[species].key in ('broadleaf', 'conifer'):
        said.append(f"'{species}' is not in the table")
    if inventory.is_height_found[row]:
        said.append('height by stem')
    if not np.isfinite(inventory.diameter[row]):
        said.append('stem by height')
    if result.note:
        said.append(result.note)
    if critical is not None and critical >= FASTEST:
        said.append(f'above {FASTEST:g} m/s')
    if result.kind.exposure != 'open' and not result.error:
        said.append(f'trees {result.exposure.scaled(inventory.height[row]).spacing:.2g} m apart')
    shelter = 'no shelter' if result.kind.exposure == 'open' else 'as high as its neighbours'
    return [*said, 'grown crown', shelter, 'roots of a mean soil']
