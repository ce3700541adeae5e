# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
From the reductions of a tree to the oscillators that step it, for every model.

A number of coordinates is stepped on a table of winds, the model ``branch`` branch by branch. The
oscillators of other models come from installed packages (`installed_models`). Modules of one model
are imported where that model is made.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any, TYPE_CHECKING

import numpy as np

from tree_sway.core.model.records import in_lines
from tree_sway.core.model.tree_state import digest_of
from tree_sway.core.run.bank import Bank, Oscillators
from tree_sway.core.setup.fill_records import block_records
from tree_sway.core.setup.modes import refuse_buckling, solvable
from tree_sway.core.setup.one_thread import one_thread
from tree_sway.core.setup.reductions import TreeReductions
from tree_sway.errors import ParameterError

if TYPE_CHECKING:
    from tree_sway.cache.model_cache import SetUpFiles
    from tree_sway.core.run.modal_coordinates import ModalCoordinates
    from tree_sway.core.run.table_model import WindBasisBank
    from tree_sway.core.setup.load_table import WindBasisTable

EVENLY_DAMPED = 40
"""
Number of natural modes of equal damping ratio; above them it grows with the frequency, as by
damping proportional to the stiffness of the wood.

"""


def assembled(
    reductions: TreeReductions, model: int | str | None = None, cache: SetUpFiles | None = None
) -> Bank:
    """
    Build the oscillators of a model: a number of coordinates, ``branch`` or an installed one.

    The model is that of the settings if None. Set-ups of modes are read from the cache, and
    written there.

    Raises
    ------
    TreeError
        A tree that buckles under its own weight, or a branch without mass.
    ParameterError
        A model without oscillators, or one that is not installed.

    """
    model = reductions.settings.model if model is None else model
    if model == 'auto':
        raise ParameterError(
            "model 'auto' has no oscillators",
            where='model',
            cure='make it by make_simulator, or give a number of coordinates',
        )
    with solvable(reductions.tree):
        if model == 'branch':
            return _bank_of_branches(reductions)
        if isinstance(model, str):
            from tree_sway.installed_models import maker_of

            return maker_of(model)(reductions, cache)
        if model == 0:
            return _rigid_bank(reductions, cache)
        return _bank_of_table(reductions, model, cache)


def _bank_of_table(reductions: TreeReductions, model: int, cache: SetUpFiles | None) -> Bank:
    """Make the coordinates and the table of their loads."""
    from tree_sway.core.run.modal_coordinates import ModalCoordinates
    from tree_sway.core.setup.load_table import WindBasisTable

    def set_up() -> dict[str, Any]:
        arrays = modal_arrays_of(reductions, model)
        coordinates = ModalCoordinates(arrays['branches'], arrays, reductions.damping_ratio)
        return {**arrays, 'table': _table(reductions, coordinates).record}

    made_of = stored_set_up(reductions, model, cache, set_up)
    coordinates = ModalCoordinates(made_of['branches'].copy(), made_of, reductions.damping_ratio)
    table = WindBasisTable.of_arrays(made_of)
    return laid_out(_on_table(coordinates, table, reductions.plain), made_of, reductions.plain)


def _on_table(coordinates: ModalCoordinates, table: WindBasisTable, plain: bool) -> WindBasisBank:
    if plain:
        from tree_sway.core.run.numpy_table import NumpyTableBank

        return NumpyTableBank(coordinates, table)
    from tree_sway.core.run.table_model import WindBasisBank

    return WindBasisBank(coordinates, table)


def _rigid_bank(reductions: TreeReductions, cache: SetUpFiles | None) -> Bank:
    """Make a tree without coordinates."""
    from tree_sway.core.run.rigid import RigidBank

    made_of = stored_set_up(reductions, 0, cache, lambda: modal_arrays_of(reductions, 0))
    bank = RigidBank(made_of['branches'].copy(), made_of, reductions.damping_ratio)
    return laid_out(bank, made_of, reductions.plain)


def stored_set_up(
    reductions: TreeReductions,
    model: int | str,
    cache: SetUpFiles | None,
    set_up: Callable[[], dict[str, Any]],
) -> dict[str, Any]:
    """Read the arrays of a model from the cache, or make and write them; both have equal bits."""
    if cache is None:
        made_of = set_up()
    else:
        settings = replace(reductions.settings, model=model)
        digest = f'{digest_of(reductions.tree, reductions.species, settings)}-{reductions.plain}'
        found = cache.read(digest)
        if found is None:
            made_of = set_up()
            cache.write(digest, made_of)
        else:
            made_of = {**found, 'segments': in_lines(found['segments'])}
    reductions.circular = made_of['natural']
    return made_of


@one_thread()
def modal_arrays_of(reductions: TreeReductions, model: int | str) -> dict[str, Any]:
    """Find the arrays by which a number of coordinates, or all, are stepped and placed."""
    from tree_sway.core.setup.bent_inertia import inertia_slopes
    from tree_sway.core.setup.modal_arrays import modal_arrays

    reduced = reductions.with_subtrees
    modes = reductions.modes(model)
    arrays = modal_arrays(reduced.branches, reduced.reduction, modes)
    n_even = min(EVENLY_DAMPED, reduced.reduction.n_coordinates)
    even = reductions.natural_modes(n_even).circular
    return {
        **arrays,
        'branches': reduced.branches,
        'segments': reduced.segments,
        'loss': np.maximum(arrays['circular'] / even[-1], 1.0),
        'natural': reductions.circular,
        'inertia_slopes': inertia_slopes(reduced.tree, reduced.places, modes.shapes, reduced.mass),
        'tree_mass': reduced.mass.sum(),
    }


@one_thread()
def _table(reductions: TreeReductions, coordinates: ModalCoordinates) -> WindBasisTable:
    from tree_sway.core.setup.load_table import WindBasisTable

    return WindBasisTable(coordinates, reductions.wind_moments, reductions.drag_law)


@one_thread()
def _bank_of_branches(reductions: TreeReductions) -> Bank:
    """Each branch's own oscillator: the mean of its two axes."""
    from tree_sway.core.run.branch_oscillators import BranchOscillators
    from tree_sway.core.setup.subtree_inertia import subtree_inertia

    tree, settings, reduced = reductions.tree, reductions.settings, reductions.isolated
    matrices, branches = reduced.reduction, reduced.branches.copy()
    refuse_buckling(tree, matrices)
    inertia = subtree_inertia(tree, matrices).reshape(-1, 2).mean(axis=1)
    inertia = inertia * np.array([model.inertia_share for model in reduced.models])
    stiffness = np.asarray(matrices.stiffness.diagonal()).reshape(-1, 2).mean(axis=1)
    weight = np.asarray(matrices.gravity.diagonal()).reshape(-1, 2).mean(axis=1)
    damping = 2.0 * reductions.damping_ratio * np.sqrt(stiffness * inertia)
    if settings.volume_stiffness:
        volume = np.add.reduceat(tree.volume, tree.branch_first[:-1])
        rule = np.sqrt(volume * volume[np.maximum(tree.branch_parent, 0)])
        stiffness, damping = settings.volume_stiffness * rule, settings.volume_damping * rule
    kind: type[BranchOscillators] = BranchOscillators
    if reductions.plain:
        from tree_sway.core.run.numpy_branch_oscillators import NumpyBranchOscillators

        kind = NumpyBranchOscillators
    oscillators = kind(branches, inertia, damping, stiffness, weight)
    made_of = {'segments': reduced.segments, 'tree_mass': reduced.mass.sum()}
    return laid_out(oscillators, made_of, reductions.plain)


def laid_out(oscillators: Oscillators, made_of: dict[str, Any], plain: bool) -> Bank:
    """Join oscillators with the records of the segments that they move."""
    branches, segments = oscillators.branches, made_of['segments']
    blocks = block_records(branches, segments)
    return Bank(oscillators, branches, segments, blocks, float(made_of['tree_mass']), plain)
