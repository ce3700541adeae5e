# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Natural modes of the coupled tree, and the refusal of a tree that cannot stand.

Few modes of a big tree come from Lanczos iteration on ``M y = mu K y``, mu = 1 / w^2 (Lehoucq,
Sorensen & Yang, 1998); all modes of a small one from the dense problem. A tree whose stiffness
with its own weight is not positive buckles (Greenhill, 1881): it is refused with the name of the
branch.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.core.reduction.matrices import Reduction
from tree_sway_ros.core.tree.tree import Tree
from tree_sway_ros.errors import ParameterError, TreeError

MOST_ALL_MODES = 3000
"""
A tree of more coordinates than this is not solved in all its modes: that takes minutes and gains
nothing.

"""

_DENSE_UP_TO = 400

_MOST_LEFT = 0.05
"""Of what wind drives slow modes to do, root mean square: as much may be left out."""


@dataclass(frozen=True)
class Modes:
    """Natural modes, slowest first: w [rad/s], (m,), key rotations of unit modal mass, (N, m)."""

    circular: Floats
    shapes: Floats

    @property
    def frequencies(self) -> Floats:
        """Natural frequencies in [Hz], (m,)."""
        frequencies: Floats = self.circular / (2.0 * np.pi)
        return frequencies

    def slowest(self, count: int) -> Modes:
        """Leave out all but the slowest."""
        return Modes(self.circular[:count], np.ascontiguousarray(self.shapes[:, :count]))


def natural_modes(tree: Tree, reduction: Reduction, count: int | None = None) -> Modes:
    """
    Find the slowest modes of a tree, all if no count is given.

    Raises
    ------
    ParameterError
        A count below 1 or above the number of coordinates.
    TreeError
        A tree that buckles under its own weight, or a branch without mass.

    """
    from scipy import linalg
    from scipy.sparse import csc_matrix
    from scipy.sparse import linalg as sparse_linalg

    n = reduction.n_coordinates
    wanted = n if count is None else count
    if count is None and n > MOST_ALL_MODES:
        raise ParameterError(
            f'all {n} modes of a tree of {tree.n_branches} branches',
            where="model 'coupled'",
            cure="use model 'modes', which errs by a few percent of the motion with 12",
        )
    if not 1 <= wanted <= n:
        raise ParameterError(
            f'{wanted} modes of a tree that has {n}', where='modes', cure=f'ask for 1 to {n}'
        )
    refuse_buckling(tree, reduction)
    if wanted == n:
        inverse_squares, shapes = linalg.eigh(
            reduction.mass.toarray(), reduction.stiffness.toarray(), driver='gvd'
        )
    elif n <= _DENSE_UP_TO or 3 * wanted > n:
        inverse_squares, shapes = linalg.eigh(
            reduction.mass.toarray(),
            reduction.stiffness.toarray(),
            subset_by_index=[n - wanted, n - 1],
        )
    else:
        stiffness = csc_matrix(reduction.stiffness)
        solve = _factors(stiffness)
        inverse_squares, shapes = sparse_linalg.eigsh(
            reduction.mass,
            k=wanted,
            M=stiffness,
            Minv=sparse_linalg.LinearOperator((n, n), matvec=solve.solve, dtype=np.float64),
            which='LA',
            v0=np.ones(n),
        )
    slowest_first = np.argsort(-inverse_squares)
    circular = 1.0 / np.sqrt(inverse_squares[slowest_first])
    return Modes(circular, np.ascontiguousarray(shapes[:, slowest_first] * circular))


def most_driven(modes: Modes, loads: Floats, moved: Floats, count: int, further: int = 0) -> Modes:
    """
    Keep so many of the modes by which turbulence moves the tips most, the slowest first.

    At its own pace a mode goes ``phi . q / (2 zeta w^2)`` under a load q, of moments (N, any);
    turbulence there has a power of ``w^(-5/3)``, over a band as wide as w. Of modes that loads do
    not reach, as branches that swing against each other, nothing is lost. ``moved`` is the sum
    over the tips of the square of what a unit of each mode moves them, (m,). Up to so many
    ``further`` ones are kept where those left out would make up more than 5 % of the root mean
    square of all.
    """
    driven = moved * np.square(modes.shapes.T @ loads).sum(axis=1) / modes.circular ** (14.0 / 3.0)
    order = np.argsort(-driven, kind='stable')
    left = 1.0 - np.cumsum(driven[order]) / max(float(driven.sum()), 1e-300)
    missed = int((left[count - 1 :] > _MOST_LEFT**2).sum())
    kept = np.sort(order[: count + min(missed, further)])
    return Modes(modes.circular[kept], np.ascontiguousarray(modes.shapes[:, kept]))


def with_static(modes: Modes, reduction: Reduction, loads: Floats) -> Modes:
    """
    Add to modes what they lack of the static answers to loads (N, l).

    With the flexibility of each coordinate alone taken as static, the answer to these loads then
    is exact (mode acceleration with Ritz vectors: Wilson, Yuan & Dickens, 1982). There are up to l
    more, orthogonal to them and to each other in mass and stiffness.
    """
    from scipy import linalg
    from scipy.sparse import csc_matrix

    stiffness, mass = csc_matrix(reduction.stiffness), reduction.mass
    rest = _factors(stiffness).solve(np.ascontiguousarray(loads))
    rest -= loads * reduction.flexibility[:, None]
    size = np.sqrt(np.einsum('nl,nl->l', rest, stiffness @ rest))
    for _ in range(2):
        rest -= modes.shapes @ (modes.shapes.T @ (mass @ rest))
    energy, inertia = rest.T @ (stiffness @ rest), rest.T @ (mass @ rest)
    missing = np.sqrt(np.diag(energy)) > 1e-6 * size
    rest, within = rest[:, missing], np.ix_(missing, missing)
    if not missing.any():
        return modes
    inverse_squares, mixes = linalg.eigh(inertia[within], energy[within])
    circular = 1.0 / np.sqrt(np.maximum(inverse_squares, 1e-12 * inverse_squares.max()))
    order = np.argsort(circular)
    circular = np.concatenate([modes.circular, circular[order]])
    shapes = np.hstack([modes.shapes, (rest @ mixes)[:, order] * circular[len(modes.circular) :]])
    slowest_first = np.argsort(circular, kind='stable')
    return Modes(circular[slowest_first], np.ascontiguousarray(shapes[:, slowest_first]))


def _factors(matrix: Any) -> Any:
    """
    Factorise a sparse matrix that is symmetric and positive definite.

    Eliminated from the twigs to the stem, its factors have no more entries than itself.
    """
    from scipy.sparse import linalg as sparse_linalg

    options = {'SymmetricMode': True}
    return sparse_linalg.splu(
        matrix, permc_spec='MMD_AT_PLUS_A', diag_pivot_thresh=0.0, options=options
    )


def buckling_factor(reduction: Reduction) -> tuple[float, int]:
    """Critical over real weight, infinite without gravity; the coordinate that gives way most."""
    from scipy import linalg
    from scipy.sparse import csc_matrix
    from scipy.sparse import linalg as sparse_linalg

    n = reduction.n_coordinates
    softening = -reduction.gravity
    if softening.nnz == 0 or abs(softening).max() == 0.0:
        return float('inf'), 0
    if n <= _DENSE_UP_TO:
        values, vectors = linalg.eigh(
            softening.toarray(), reduction.elastic.toarray(), subset_by_index=[n - 1, n - 1]
        )
    else:
        elastic = csc_matrix(reduction.elastic)
        solve = _factors(elastic)
        values, vectors = sparse_linalg.eigsh(
            softening,
            k=1,
            M=elastic,
            Minv=sparse_linalg.LinearOperator((n, n), matvec=solve.solve, dtype=np.float64),
            which='LA',
            v0=np.ones(n),
        )
    worst = int(np.argmax(np.abs(vectors[:, 0])))
    return (1.0 / float(values[0]) if values[0] > 0.0 else float('inf')), worst


def refuse_buckling(tree: Tree, reduction: Reduction) -> None:
    """Refuse, by a `TreeError`, a tree that its weight buckles, or a branch without mass."""
    diagonal = reduction.mass.diagonal()
    for coordinate in np.flatnonzero(~(diagonal > 0.0))[:1]:
        raise TreeError(
            'massless: it has a length but nothing that could swing',
            where=_branch_name(tree, reduction, int(coordinate)),
            cure='give its segments a diameter and the wood a density above 0',
        )
    factor, coordinate = buckling_factor(reduction)
    if factor <= 1.0:
        raise TreeError(
            f'buckles under its own weight: it could carry {100.0 * factor:.0f} % of it',
            where=_branch_name(tree, reduction, coordinate),
            cure=f'give a modulus {1.05 / factor:.2f} times as high or diameters '
            f'{factor**-0.5 * 1.03:.2f} '
            'times as thick, or leave its weight out: gravity 0, --gravity off',
        )


def _branch_name(tree: Tree, reduction: Reduction, coordinate: int) -> str:
    branch = int(np.searchsorted(reduction.first, coordinate, side='right')) - 1
    return f"branch '{tree.branch_names[branch]}'"
