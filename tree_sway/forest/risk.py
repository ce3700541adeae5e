# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Critical winds of the trees of an inventory: a row each, from the curves of its kind.

Trees of a kind have one species, and heights and stems near each other. Each is scaled to its own:
a tree as its kind, but larger, uses the same share in the same wind at its crown, which is taken
three quarters up, among neighbours that grow in proportion. Leaves, and with them the load, follow
the section d^2 of the stem (pipe model, `leaf_traits`; d^2 h U^2 in Hale et al. 2012); bare
branches are in proportion to d. The strength of the stem is that of its section modulus, d^3, as
is that of roots; in a stand that of roots is of the mass of the stem, d^2.

Years between winds are those of a `Climate`. A tree without leaves in winter meets the winds of
the whole year bare, and those of the summer in leaf: the rates of both add up. Of such trees the
weaker fall first: the share that falls in 50 years is that of a log-normal band.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from statistics import NormalDist
from typing import Any

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.files.scenes import Inventory, kind_classes
from tree_sway.forest.climate import beaufort, Climate, INLAND, SUMMER
from tree_sway.forest.cluster import cluster, DEADLINE, run_all
from tree_sway.forest.risk_kind import (
    compute_kind,
    KindResult,
    RiskKind,
    SeasonCurves,
)
from tree_sway.simulation import Exposure, root_band, wood_band

Row = dict[str, Any]

CRITICAL = 'critical_wind_10m [m/s]'

_CARRIED_ON = 'carried on from slower winds'
_FASTEST = 80.0
"""Critical wind above which trees are not told apart [m/s]; no storm has such a mean wind."""
_MOST_KINDS = 64
"""Number of kinds up to which trees are told apart, so that large inventories take minutes."""
_RAREST = 10_000
"""Years between winds above which they are not told apart; no record is as long."""
CLASSES = 5
_LIFE = 50.0
_FALL = 'fall_in_50_years [%]'
_WEAKER = np.array([NormalDist().inv_cdf((k + 0.5) / 1e3) for k in range(1000)]) / 1.2816
"""Critical winds of a thousand such trees: powers of the ratio of ``low_80`` to the middle."""
_FOUND = (
    'limited_by', CRITICAL, 'critical_wind_10m [km/h]', 'beaufort', 'low_80 [m/s]',
    'high_80 [m/s]', 'stem [m/s]', 'roots [m/s]', 'years', _FALL, 'class',
)  # fmt: skip
_CROWN = 0.75
_KM_H = 3.6
_WIDER = 1.25


@dataclass(frozen=True)
class RiskWork:
    """Kinds of an inventory, and the rows of each."""

    inventory: Inventory
    kinds: dict[RiskKind, list[int]]
    climate: Climate = INLAND


def risk_work(
    inventory: Inventory,
    seed: int = 0,
    *,
    exposure: str = 'open',
    spacing: float | None = None,
    climate: Climate = INLAND,
) -> RiskWork:
    """
    Group the trees of an inventory into kinds, at most `_MOST_KINDS` for each exposure.

    There are two for each species if those are more.

    Parameters
    ----------
    inventory
        The trees.
    seed
        Seed of grown trees and gusts.
    exposure
        Exposure of trees for which the inventory has none, one of `EXPOSURES`.
    spacing
        Mean distance between the trees of a stand in [m]; 0.18 of their height if None.
    climate
        How often its winds come.

    """
    keys = [inventory.wood[each].key for each in inventory.species]
    exposures = [each or exposure for each in inventory.exposures]
    most = max(_MOST_KINDS, 2 * len(set(keys))) * len(set(exposures))
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
            apart = 0.0 if spacing is None or Exposure(where).is_alone else spacing
            kind = RiskKind(key, height, slenderness, seed, where, apart)
            kinds.setdefault(kind, []).append(row)
        if len(kinds) <= most or heights > 20.0:
            return RiskWork(inventory, kinds, climate)
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
            distributed, client, compute_kind, pieces, _is_result, deadline=deadline
        ):
            rows = rows_of_kind(work, result)
            yield len(rows), rows


def _is_result(result: Any, kind: RiskKind) -> bool:
    """Whether a worker returned what was asked of it."""
    return isinstance(result, KindResult) and result.kind == kind


def rows_of_kind(work: RiskWork, result: KindResult) -> list[Row]:
    """Return the rows of all trees of a kind."""
    return [_row(work, row, result) for row in work.kinds[result.kind]]


def add_classes(rows: Sequence[Row]) -> None:
    """Say in which fifth of the rows each falls, by critical winds: 1 falls first."""
    ranked = sorted(
        (row for row in rows if row[CRITICAL] is not None), key=lambda row: row[CRITICAL]
    )
    for rank, row in enumerate(ranked):
        row['class'] = 1 + CLASSES * rank // len(ranked)


def _row(work: RiskWork, row: int, result: KindResult) -> Row:
    inventory = work.inventory
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
    limits = [
        (winds[part][1] / _calm(curves, result), part, curves, winds)
        for curves in result.seasons
        for winds in [_winds(curves, height, diameter, result)]
        for part in [min(winds, key=lambda each: winds[each][1])]
    ]
    if limits:
        _, part, curves, winds = min(limits, key=lambda limit: limit[0])
        low, middle, high = winds[part]
        per_year = work.climate.per_year
        found |= {
            'limited_by': f'{part}, {"in leaf" if curves.in_leaf else "bare"}',
            CRITICAL: round(middle, 2),
            'critical_wind_10m [km/h]': round(_KM_H * middle, 2),
            'beaufort': beaufort(middle),
            'low_80 [m/s]': round(low, 2),
            'high_80 [m/s]': round(high, 2),
            'stem [m/s]': round(winds['stem'][1], 2),
            'roots [m/s]': round(winds['roots'][1], 2),
            'years': _years(float(sum(per_year(limit[0]) for limit in limits))),
            _FALL: _falling(
                [per_year(each * (by[of][0] / by[of][1]) ** _WEAKER) for each, of, _, by in limits]
            ),
        }
    found |= dict.fromkeys(name for name in _FOUND if name not in found)
    critical = found[CRITICAL]
    return found | {'assumed': '; '.join(_assumed(inventory, row, result, critical))}


def is_beyond(row: Row) -> bool:
    """Whether the wind of a row is above those that were computed, and only estimated."""
    return any(each in row['assumed'] for each in (_CARRIED_ON, 'above '))


def _calm(curves: SeasonCurves, result: KindResult) -> float:
    """Wind of the season over that of the year [-]: leaves that fall meet the summer's."""
    return SUMMER if curves.in_leaf and len(result.seasons) > 1 else 1.0


def _years(rate: float) -> float:
    """Years between winds of a rate per year, to two digits."""
    return float(f'{min(1.0 / max(rate, 1e-9), _RAREST):.2g}')


def _falling(rates: Sequence[Floats]) -> float:
    """Share of trees that falls in `_LIFE` years [%], to two digits, by rates of its limits."""
    falling = -np.expm1(-_LIFE * np.sum(rates, axis=0))
    return float(f'{100.0 * float(falling.mean()):.2g}')


def _winds(
    curves: SeasonCurves, height: float, diameter: float, result: KindResult
) -> dict[str, list[float]]:
    """Critical winds at 10 m of stem and roots [m/s]: low, middle and high."""
    slenderness = height / diameter if np.isfinite(diameter) else result.slenderness
    load = 2.0 if curves.in_leaf else 1.0
    own = result.exposure.scaled(height)
    scale = _at_crown(result.exposure.scaled(result.kind.height)) / _at_crown(own)
    scale *= own.at_ten_metres
    parts = {
        'stem': (curves.stem, wood_band, 3.0),
        'roots': (curves.roots, root_band, 3.0 if own.is_alone else 2.0),
    }
    return {
        part: sorted(
            min(scale * curve.speed_of(1.0 / (used * more)), _FASTEST)
            for used in band(in_leaf=curves.in_leaf).tolist()
        )
        for part, (curve, band, power) in parts.items()
        for more in [(slenderness / result.slenderness) ** (power - load)]
    }


def _at_crown(exposure: Exposure) -> float:
    """Wind three quarters up a tree over the mean wind of its exposure [-]."""
    return float(exposure.profile().over_anemometer(np.array(_CROWN * exposure.height)))


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
    if critical is not None and critical >= _FASTEST:
        said.append(f'above {_FASTEST:g} m/s')
    elif critical is not None:
        fastest = max(float(each.stem.speed[-1]) for each in result.seasons)
        if critical > fastest * result.exposure.at_ten_metres:
            said.append(_CARRIED_ON)
    if not result.exposure.is_alone and not result.error:
        said.append(f'trees {result.exposure.scaled(inventory.height[row]).spacing:.2g} m apart')
    shelter = 'no shelter' if result.exposure.is_alone else 'as high as its neighbours'
    roots = 'roots as strong as the stem' if result.exposure.is_alone else 'roots of a mean soil'
    return [*said, 'grown crown', shelter, 'sound wood', roots]
