# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Making of a `SwayModel` from a reduced tree: the order of the set-up.

Branches become beams and matrices (`reduced_tree`), these become coordinates (`modes`), and the
load of all uniform winds on them a table (`load_table`).
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.model import LOADED, PLACED, StateBasis, SwayModel
from tree_sway.core.oscillators import LOAD_MAX
from tree_sway.core.setup.bent_inertia import inertia_slopes
from tree_sway.core.setup.damping import relative_damping
from tree_sway.core.setup.leaning_responses import leaning_responses
from tree_sway.core.setup.load_table import fit_harmonics, load_table
from tree_sway.core.setup.modal_arrays import Coordinates, modal_arrays
from tree_sway.core.setup.modes import refuse_buckling, solvable
from tree_sway.core.setup.reduced_tree import ReducedTree
from tree_sway.core.setup.reductions import TreeReductions
from tree_sway.core.setup.rest_loads import rest_loads
from tree_sway.core.setup.stream_basis import (
    arrays_of_stream,
    basis_of_responses,
    stream_arrays,
    WEIGHTS,
)
from tree_sway.core.setup.subtree_inertia import subtree_inertia
from tree_sway.core.setup.threads import one_thread
from tree_sway.core.wind.gusts import delays_of, N_DELAYS, parts_of


def make_model(reductions: TreeReductions) -> SwayModel:
    """Make the model of a tree; a `TreeError` refuses one that cannot be solved."""
    with solvable(reductions.tree):
        if reductions.settings.model == 'branch':
            return _isolated_branches(reductions)
        return _coupled_tree(reductions)


@one_thread()
def _coupled_tree(reductions: TreeReductions) -> SwayModel:
    """Prepare the whole tree on some or all coordinates, on some with a table of loads."""
    settings = reductions.settings
    reduced = reductions.with_subtrees
    modes = reductions.modes(settings.model)
    # One coordinate after the other in memory, so that loops over key rotations are vectorised.
    shapes = np.ascontiguousarray(modes.shapes.T).T
    arrays = modal_arrays(reduced.branches, reduced.reduction, modes)
    relative = relative_damping(reductions, modes)
    slopes = inertia_slopes(reduced.tree, reduced.places, modes.shapes, reduced.mass)
    coordinates = Coordinates(
        shapes,
        modes.circular**2,
        2.0 * reductions.damping_ratio * relative * modes.circular,
        slopes,
        arrays['participation'],
        reduced.branches['area'],
    )
    table: dict[str, Any] = {}
    if isinstance(settings.model, int) and modes.circular.size:
        table = load_table(
            coordinates,
            reductions.wind_moments,
            reductions.drag_law,
            partial(rest_loads, reduced, shapes, None),
        )
    order = np.argsort(reduced.branches['first'])
    return SwayModel(
        **_whole(reductions, reduced),
        stiffness=coordinates.stiffness,
        own_damping=coordinates.damping,
        weight=arrays['weight'],
        natural_frequencies=reductions.frequencies,
        shapes=shapes,
        projection=arrays['momentum'].T,
        relative_damping=relative,
        participation=arrays['participation'][order],
        key_limit=LOAD_MAX * arrays['diagonal'],
        branch_compliance=arrays['branch_compliance'],
        shape_compliance=arrays['mode_compliance'],
        inertia_slopes=slopes,
        **_stream(reductions, coordinates, arrays['momentum'].T, table),
        **table,
        **_limbs(reductions, reduced, order, shapes if table else None),
        **(_limp(reduced, shapes, settings.gravity) if shapes.size and reductions.is_limp else {}),
    )


def _limp(reduced: ReducedTree, shapes: Floats, gravity: float) -> dict[str, Any]:
    """Find what the step of a limp tree needs (``native/limp.h``)."""
    from tree_sway.core.setup.weight_slopes import weight_slopes

    mass = np.empty(len(reduced.mass))
    mass[reduced.row] = reduced.mass
    slopes = weight_slopes(reduced.tree, reduced.places, shapes, reduced.mass, gravity)
    return {'segment_mass': mass, 'weight_slopes': slopes}


def _stream(
    reductions: TreeReductions, coordinates: Coordinates, projection: Floats, table: dict[str, Any]
) -> dict[str, Any]:
    """
    Find the basis of the stream.

    It comes from the responses of the leaning tree by its table, and where there is none from the
    responses to gusts and winds that the coordinates come from.
    """
    law = reductions.drag_law
    shapes = coordinates.shapes
    branches = reductions.with_subtrees.branches
    if table:
        own = coordinates.stiffness, coordinates.damping
        return stream_arrays(branches, shapes, leaning_responses(table, *own, law, tuple(WEIGHTS)))
    if not coordinates.stiffness.size:
        return arrays_of_stream(StateBasis(np.zeros((0, 0)), np.zeros((0, 0)), np.zeros(0), 0.0))
    responses = reductions.responses
    in_gale = responses.in_gale * responses.rotations
    found = basis_of_responses(branches, responses.rotations, in_gale)
    matrix = projection @ found.matrix
    back = found.projection @ shapes
    return arrays_of_stream(replace(found, matrix=matrix, projection=back))


@one_thread()
def _isolated_branches(reductions: TreeReductions) -> SwayModel:
    """Prepare each branch's own oscillator: the mean of its two axes."""
    settings = reductions.settings
    tree = reductions.tree
    reduced = reductions.isolated
    matrices = reduced.reduction
    refuse_buckling(tree, matrices)
    inertia = _of_branches(subtree_inertia(tree, matrices))
    inertia = inertia * np.array([model.inertia_share for model in reduced.models])
    stiffness = _of_branches(np.asarray(matrices.stiffness.diagonal()))
    damping = 2.0 * reductions.damping_ratio * np.sqrt(stiffness * inertia)
    if settings.volume_stiffness:
        volume = np.add.reduceat(tree.volume, tree.branch_first[:-1])
        rule = np.sqrt(volume * volume[np.maximum(tree.branch_parent, 0)])
        stiffness = settings.volume_stiffness * rule
        damping = settings.volume_damping * rule
    circular = np.sort(np.sqrt(stiffness / inertia))
    return SwayModel(
        **_whole(reductions, reduced),
        stiffness=stiffness,
        own_damping=damping,
        weight=_of_branches(np.asarray(matrices.gravity.diagonal())),
        natural_frequencies=circular / (2.0 * np.pi),
        inertia=inertia,
        **_limbs(reductions, reduced, np.arange(tree.n_branches), None),
    )


def _of_branches(values: Floats) -> Floats:
    """Mean over the two axes of each branch, (b,)."""
    return np.asarray(values.reshape(-1, 2).mean(axis=1))


def _whole(reductions: TreeReductions, reduced: ReducedTree) -> dict[str, Any]:
    """
    Arrays for placing, and of the load of each branch.

    Branches are in the order of their first segments in the tree: a branch that is cut is several,
    and in a cut tree the children of its first piece come before the second.
    """
    records = reduced.branches
    places = reduced.places
    order = np.argsort(records['first'])
    row = np.argsort(reduced.row)
    """Segment of the cut tree for each one of the tree."""
    number = np.argsort(order)
    parent = records['parent'][order]
    branches = records[order]
    return {
        'tree': reductions.tree,
        'species': reductions.species,
        'settings': reductions.settings,
        'drag_law': reductions.drag_law,
        'damping_ratio': reductions.damping_ratio,
        'mass': float(reduced.mass.sum()),
        'branch_first': np.append(branches['first'], reductions.tree.n_segments),
        'branch_parent': np.where(parent < 0, -1, number[np.maximum(parent, 0)]),
        'branch_keys': branches['n_coordinates'].copy(),
        'branch_skew': np.stack([places.skew, places.tip_skew], axis=1)[order],
        **{
            f'branch_{name}': branches[name].copy()
            for name in ('base_segment', 'coordinate', *PLACED, *LOADED)
        },
        'segment_slope': places.slope[row],
        'segment_tip_slope': places.tip_slope[row],
        'segment_chord': places.chord[row],
        'segment_rest': places.rest[row],
        'segment_turn': places.segment_turn[row],
    }


def _limbs(
    reductions: TreeReductions, reduced: ReducedTree, order: Ints, shapes: Floats | None
) -> dict[str, Any]:
    """Delays with which gusts reach the limbs, and the load on each of them on shapes (N, m)."""
    if not reductions.settings.has_limb_winds:
        return {}
    of = parts_of if reductions.settings.is_far else delays_of
    delays = of(reductions.tree, reductions.leaf_load_area)
    of_piece = delays.of_branch[reduced.branch]
    found: dict[str, Any] = {
        'limb_delay': of_piece[order],
        'limb_spread': np.array([delays.spread]),
        'limb_share': delays.share,
    }
    if shapes is not None:
        found['limb_harmonics'] = np.array(
            [
                fit_harmonics(partial(rest_loads, reduced, shapes, of_piece == delay))[0]
                for delay in range(N_DELAYS)
            ]
        )
    return found
