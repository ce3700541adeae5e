# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
From the reductions of a tree to the oscillators that step it, for every model.

Modules of one model are imported where that model is made.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from typing import Any, TYPE_CHECKING

import numpy as np

from tree_sway.core.arrays import Floats, Records
from tree_sway.core.model.drag_law import DragLaw
from tree_sway.core.model.records import in_lines
from tree_sway.core.model.state_basis import StateBasis
from tree_sway.core.model.tree_state import digest_of
from tree_sway.core.run.bank import Bank, Oscillators
from tree_sway.core.setup.fill_records import block_records
from tree_sway.core.setup.modes import refuse_buckling, solvable
from tree_sway.core.setup.one_thread import one_thread
from tree_sway.core.setup.reductions import TreeReductions
from tree_sway.errors import ParameterError

if TYPE_CHECKING:
    from tree_sway.cache.model_cache import SetUpFiles
    from tree_sway.core.run.modal import ModalBank
    from tree_sway.core.run.table_model import WindBasisBank
    from tree_sway.core.setup.load_table import WindBasisTable

EVENLY_DAMPED = 40
"""
Number of natural modes of equal damping ratio; above them it grows with the frequency, as by
damping proportional to the stiffness of the wood.

"""

_OF_STREAM = (
    'shapes', 'momentum', 'stream_shapes', 'stream_projection', 'stream_scale', 'stream_error',
)  # fmt: skip
"""Arrays of a set-up that make the basis of the stream."""


def assembled(
    reductions: TreeReductions, model: int | str | None = None, cache: SetUpFiles | None = None
) -> Bank:
    """
    Build the oscillators of a model: a number of coordinates, ``branch`` or ``full``.

    The model is that of the settings if None. Set-ups of modes are read from the cache, and
    written there.

    Raises
    ------
    TreeError
        A tree that buckles under its own weight, or a branch without mass.
    ParameterError
        A model without oscillators.

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
        return _bank_of_modes(reductions, model, cache)


def _bank_of_modes(reductions: TreeReductions, model: int | str, cache: SetUpFiles | None) -> Bank:
    """Read a set-up from the cache, or make one; both have the same bits."""
    digest, found = '', None
    if cache is not None:
        settings = replace(reductions.settings, model=model)
        digest = f'{digest_of(reductions.tree, reductions.species, settings)}-{reductions.plain}'
        found = cache.read(digest)
    made_of = _modal_arrays(reductions, model) if found is None else found
    reductions.circular = made_of['natural']
    branches = made_of['branches'].copy()
    from tree_sway.core.run.modal import ModalBank

    kind: type[ModalBank] = ModalBank
    if reductions.plain:
        from tree_sway.core.run.numpy_banks import NumpyModalBank

        kind = NumpyModalBank
    modal = kind(branches, made_of, reductions.damping_ratio)
    oscillators: Oscillators = modal
    find_basis = partial(_basis_of_responses, reductions)
    if model != 'full' and model != 0:
        from tree_sway.core.setup.load_table import WindBasisTable

        table = _table(reductions, modal) if found is None else WindBasisTable.of_arrays(found)
        made_of['table'] = table.record
        if found is None:
            made_of |= _stream_arrays(reductions, modal, table)
        oscillators = _bank_of_table(modal, table, reductions.plain)
        find_basis = partial(_basis_of_arrays, {name: made_of[name] for name in _OF_STREAM})
    if found is None and cache is not None:
        cache.write(digest, made_of)
    segments = made_of['segments'] if found is None else in_lines(made_of['segments'])
    mass = float(made_of['tree_mass'])
    return _laid_out(oscillators, branches, segments, mass, find_basis, reductions.plain)


@one_thread()
def _stream_arrays(
    reductions: TreeReductions, modal: ModalBank, table: WindBasisTable
) -> dict[str, Any]:
    """Find the basis of the stream from the table, as arrays."""
    from tree_sway.core.setup.leaning_responses import leaning_responses
    from tree_sway.core.setup.stream_basis import stream_arrays, WEIGHTS

    law, record = reductions.drag_law, table.record[0]
    responses = leaning_responses(record, modal.damping, law, tuple(WEIGHTS))
    return stream_arrays(modal.branches, modal.shapes, responses)


def _basis_of_arrays(made_of: Mapping[str, Any]) -> StateBasis:
    """Return the basis of the stream that is stored with a set-up, as one of key rotations."""
    matrix = made_of['shapes'].T @ made_of['stream_shapes']
    projection = made_of['stream_projection'] @ made_of['momentum'].T
    return StateBasis(
        matrix, projection, made_of['stream_scale'], float(made_of['stream_error'][0])
    )


@one_thread()
def _basis_of_responses(reductions: TreeReductions) -> StateBasis:
    """Find the basis of a tree that is stepped in all its coordinates."""
    from tree_sway.core.setup.stream_basis import basis_of_responses

    responses = reductions.responses
    branches, rotations = reductions.with_subtrees.branches, responses.rotations
    return basis_of_responses(branches, rotations, responses.in_gale * rotations)


def _bank_of_table(modal: ModalBank, table: WindBasisTable, plain: bool) -> WindBasisBank:
    if plain:
        from tree_sway.core.run.numpy_table import NumpyTableBank

        return NumpyTableBank(modal, table)
    from tree_sway.core.run.table_model import WindBasisBank

    return WindBasisBank(modal, table)


@one_thread()
def _modal_arrays(reductions: TreeReductions, model: int | str) -> dict[str, Any]:
    """Find the arrays by which modes are stepped and placed."""
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
def _table(reductions: TreeReductions, modal: ModalBank) -> WindBasisTable:
    from tree_sway.core.setup.load_table import WindBasisTable

    return WindBasisTable(modal, reductions.wind_moments, reductions.drag_law)


@one_thread()
def _bank_of_branches(reductions: TreeReductions) -> Bank:
    """Each branch's own oscillator: the mean of its two axes."""
    from tree_sway.core.run.branch_oscillators import UncoupledBank
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
    kind: type[UncoupledBank] = UncoupledBank
    if reductions.plain:
        from tree_sway.core.run.numpy_banks import NumpyUncoupledBank

        kind = NumpyUncoupledBank
    oscillators = kind(branches, inertia, damping, stiffness, weight)
    mass, law = float(reduced.mass.sum()), reductions.drag_law
    made_of = inertia.copy(), damping.copy(), stiffness.copy()
    find_basis = partial(_basis_of_isolated, branches, made_of, law)
    return _laid_out(oscillators, branches, reduced.segments, mass, find_basis, reductions.plain)


@one_thread()
def _basis_of_isolated(
    branches: Records, oscillators: tuple[Floats, Floats, Floats], law: DragLaw
) -> StateBasis:
    """Find the basis of branches whose inertia, damping and stiffness are their own, (b,)."""
    from tree_sway.core.setup.stream_basis import basis_of_responses
    from tree_sway.core.setup.uncoupled_responses import uncoupled_responses

    return basis_of_responses(branches, *uncoupled_responses(branches, *oscillators, law))


def _laid_out(
    oscillators: Oscillators,
    branches: Records,
    segments: Records,
    mass: float,
    find_basis: Callable[[], StateBasis],
    plain: bool,
) -> Bank:
    blocks = block_records(branches, segments)
    return Bank(oscillators, branches, segments, blocks, mass, find_basis, plain)
