# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""One case from plain data to plain numbers, in any process."""

from __future__ import annotations

from collections import OrderedDict
from dataclasses import replace
import json
import math

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.checks import within
from tree_sway.core.species import species_named
from tree_sway.core.wind import FASTEST_WIND, simulate_turbulence
from tree_sway.files.models import use_disk_cache
from tree_sway.files.trees import open_tree, TreeFile
from tree_sway.files.wind import read_wind, WindRecord
from tree_sway.forest.entries import Plain
from tree_sway.forest.plan import Case
from tree_sway.growth import grow
from tree_sway.simulation import Rig

_UNITS = {'height': ' [m]', 'speed': ' [m/s]', 'intensity': ' [-]', 'scale': ' [-]'}


def compute(case: Case, *, tree: TreeFile | None = None, wind: WindRecord | None = None) -> Plain:
    """
    Compute a case.

    Parameters
    ----------
    case
        Case to compute.
    tree, wind
        Contents of its files where they were read before; read here if None.

    Returns
    -------
    dict
        Values of the case and its results, by names with their units.

    Raises
    ------
    TreeSwayError
        An impossible tree, wind or setting.

    """
    rig, frequency, warnings = _rig(case, tree)
    record = rig.run(_wind(case, wind), rate=case.rate, seconds=case.seconds)
    row: Plain = {**_prefixed('tree', case.tree), **_prefixed('wind', case.wind), **case.settings}
    row |= {
        'length [s]': len(record.time) / case.rate, 'branches': rig.tree.n_branches,
        'segments': rig.tree.n_segments, 'height [m]': rig.tree.height,
        'model': record.model, 'frequency [Hz]': frequency,
        'wind_mean [m/s]': float(np.linalg.norm(record.wind.mean(axis=0))),
        'wind_largest [m/s]': float(np.linalg.norm(record.wind, axis=1).max()),
    }  # fmt: skip
    row |= _summary('tip', 'm', record.tips[:, 0])
    row |= _summary('base_moment', 'N m', record.base_moment)
    row['strain_largest [-]'] = float(np.abs(record.base_strain).max())
    row |= _used('wood', record.strength.wood) | _used('roots', record.strength.roots)
    row['notes'] = '; '.join((*warnings, *record.notes))
    return row


def is_row_of(row: object, case: Case) -> bool:
    """Whether something is a row of a case: with what was asked, results, and finite numbers."""
    asked: Plain = {
        **_prefixed('tree', case.tree), **_prefixed('wind', case.wind), **case.settings,
    }  # fmt: skip
    asked.pop('model', None)  # a row has the one that was made
    if not (isinstance(row, dict) and asked.items() <= row.items() and row.keys() >= _RESULTS):
        return False
    values = [value for name, value in row.items() if name not in asked and value is not None]
    numbers = [each for each in values if not isinstance(each, str)]
    return all(isinstance(each, int | float) and math.isfinite(each) for each in numbers)


_RESULTS = {'length [s]', 'frequency [Hz]', 'tip_largest [m]', 'strain_largest [-]', 'notes'}
"""Names that every row has, among others."""

_MOST_RIGS = 2
_RIGS: OrderedDict[str, tuple[Rig, float, tuple[str, ...]]] = OrderedDict()
"""The last set-ups of this process, by tree and settings."""


def _rig(case: Case, tree: TreeFile | None) -> tuple[Rig, float, tuple[str, ...]]:
    """Set up a tree, its frequency [Hz] and its warnings; the next case often has the same."""
    asked = json.dumps([case.tree, case.settings, case.digest], sort_keys=True)
    if asked not in _RIGS:
        use_disk_cache()  # in each process of a study
        opened = _tree(case) if tree is None else tree
        rig = Rig(opened, **case.settings)
        _RIGS[asked] = rig, float(rig.reductions.natural_frequencies(1)[0]), opened.warnings
        while len(_RIGS) > _MOST_RIGS:
            _RIGS.popitem(last=False)
    return _RIGS[asked]


def _tree(case: Case) -> TreeFile:
    asked = case.tree
    if 'species' in asked:
        species = species_named(asked['species'])
        rng = np.random.default_rng(asked['seed'])
        return TreeFile(grow(species.key, asked['height'], rng=rng), species, 'grown')
    name = asked.get('file') or asked['name']
    return open_tree(name, in_leaf=case.settings.get('in_leaf'), warn=False)


def _wind(case: Case, record: WindRecord | None = None) -> WindRecord | Floats:
    if 'file' in case.wind:
        record = read_wind(case.wind['file']) if record is None else record
        scale = case.wind['scale']
        _refuse_too_fast(record, scale)
        return replace(record, velocity=scale * record.velocity)
    rng = np.random.default_rng(case.wind['seed'])
    return simulate_turbulence(
        case.wind['speed'], rate=case.rate, duration=case.seconds, rng=rng,
        intensity=case.wind['intensity'],
    )  # fmt: skip


def _refuse_too_fast(record: WindRecord, scale: float) -> None:
    """Raise a `ParameterError` for a scale that makes samples too fast, which would be dropped."""
    fastest = float(np.linalg.norm(record.velocity, axis=1).max())
    if fastest <= FASTEST_WIND < scale * fastest:
        within('scale', scale, 0.0, FASTEST_WIND / fastest)


def _used(part: str, share: Floats) -> Plain:
    """Largest used share of the strength of a part, and its band; None if unknown."""
    names = (f'{part}_strength_used{band} [-]' for band in ('', '_low', '_high'))
    values = (value if np.isfinite(value) else None for value in share.tolist())
    return dict(zip(names, values, strict=True))


def _prefixed(what: str, asked: Plain) -> Plain:
    return {f'{what}_{key}{_UNITS.get(key, "")}': value for key, value in asked.items()}


def _summary(name: str, unit: str, rows: Floats) -> Plain:
    length = np.linalg.norm(rows, axis=1)
    about = np.linalg.norm(np.std(rows, axis=0))
    mean = np.linalg.norm(rows.mean(axis=0))
    return {
        f'{name}_mean [{unit}]': float(mean),
        f'{name}_rms [{unit}]': float(about),
        f'{name}_largest [{unit}]': float(length.max()),
    }
