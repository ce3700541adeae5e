# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Natural modes of the coupled tree, and the refusal of a tree that buckles.

Few modes of a big tree come from Lanczos iteration on ``M y = mu K y``, mu = 1 / w^2 (Lehoucq,
Sorensen & Yang, 1998); all modes of a small one from the dense problem. A tree whose stiffness
with its own weight is not positive buckles (Greenhill, 1881): it is refused with the name of the
branch.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.setup.matrices import Factors, Reduction
from tree_sway.core.tree import Tree
from tree_sway.errors import ParameterError, TreeError

_MOST_ALL_MODES = 3000
"""
Largest number of coordinates of a tree that is solved in all its modes: more take minutes without
gain.

"""

_DENSE_UP_TO = 400

_ENOUGH = 1e-6
"""Relative error at which Lanczos iteration ends; that of eigenvalues is far smaller."""

_NEW = 1e-12
"""Smallest squared motion of the tips of a further shape, over the largest."""


@dataclass(frozen=True)
class Modes:
    """Natural modes, slowest first: w [rad/s], (m,), key rotations of unit modal mass, (N, m)."""

    circular: Floats
    shapes: Floats

    @property
    def frequencies(self) -> Floats:
        """Natural frequencies in [Hz], (m,)."""
        return np.asarray(self.circular / (2.0 * np.pi))

    def slowest(self, count: int) -> Modes:
        """Return the slowest modes."""
        return Modes(self.circular[:count], np.ascontiguousarray(self.shapes[:, :count]))

    def slower_than(self, circular: float) -> Modes:
        """Return the modes below a circular frequency [rad/s], in their order."""
        kept = self.circular < circular
        return Modes(self.circular[kept], np.ascontiguousarray(self.shapes[:, kept]))


@contextmanager
def solvable(tree: Tree) -> Iterator[None]:
    """Raise a `TreeError` where linear algebra fails, as for a broken scan."""
    try:
        yield
    except (np.linalg.LinAlgError, RuntimeError) as error:
        raise TreeError(
            f'cannot be solved ({error}): diameters or lengths differ by too many powers of ten',
            where=tree.name,
            cure='take out segments that are far too thick, thin or long',
        ) from error


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

    n = reduction.n_coordinates
    wanted = n if count is None else count
    if count is None and n > _MOST_ALL_MODES:
        raise ParameterError(
            f'all {n} modes of a tree of {tree.n_branches} branches',
            where="model 'full'",
            cure='give a number of coordinates: 60 suffice for most trees',
        )
    if not 1 <= wanted <= n:
        raise ParameterError(
            f'{wanted} modes of a tree that has {n}', where='modes', cure=f'ask for 1 to {n}'
        )
    refuse_buckling(tree, reduction)
    if wanted == n or n <= _DENSE_UP_TO or 3 * wanted > n:
        how = {'driver': 'gvd'} if wanted == n else {'subset_by_index': [n - wanted, n - 1]}
        dense = reduction.mass.toarray(), reduction.stiffness.toarray()
        inverse_squares, shapes = linalg.eigh(*dense, **how)
    else:
        inverse_squares, shapes = _slowest(reduction, wanted)
    # Below rounding a mode is rigid.
    inverse_squares = np.maximum(inverse_squares, 1e-16 * inverse_squares.max())
    slowest_first = np.argsort(-inverse_squares)
    circular = 1.0 / np.sqrt(inverse_squares[slowest_first])
    return Modes(circular, np.ascontiguousarray(shapes[:, slowest_first] * circular))


def leading_modes(reduction: Reduction, answers: Floats, tips: Floats, count: int) -> Modes:
    """
    Find the coordinates that cover most of the motion of a tree in winds.

    They are the proper orthogonal decomposition of the motion of the tips (Berkooz, Holmes &
    Lumley, 1993), and the modes of the tree within these shapes (Rayleigh-Ritz).

    Parameters
    ----------
    reduction
        Reduction of the tree.
    answers, tips
        Key rotations [rad], (N, k), multiplied by their weights, and the motion of the tips by
        them, (any, k).
    count
        Largest number of coordinates.

    Returns
    -------
    Modes
        Coordinates, orthogonal in mass and stiffness, those that move the tips most first; their
        frequencies are Rayleigh's quotients.

    """
    from scipy import linalg

    stiffness = reduction.stiffness
    mass = reduction.mass
    squares, mixes = np.linalg.eigh(tips.T @ tips)
    chosen = [i for i in np.argsort(-squares)[:count] if squares[i] > _NEW * squares[-1]]
    shapes = answers @ mixes[:, chosen]
    tips = tips @ mixes[:, chosen]
    stiff = stiffness @ shapes
    scale = 1.0 / np.sqrt(np.einsum('nl,nl->l', shapes, stiff))
    shapes *= scale
    inverse_squares, mixes = linalg.eigh(shapes.T @ (mass @ shapes), shapes.T @ (stiff * scale))
    circular = 1.0 / np.sqrt(np.maximum(inverse_squares, 1e-12 * inverse_squares.max()))
    shapes = (shapes @ mixes) * circular
    amounts = np.square((mass @ shapes).T @ answers).sum(axis=1)
    tips = (tips * scale @ mixes) * circular
    order = np.argsort(-amounts * np.square(tips).sum(axis=0), kind='stable')
    return Modes(circular[order], np.ascontiguousarray(shapes[:, order]))


def buckling_factor(reduction: Reduction) -> tuple[float, int]:
    """Return critical over real weight, infinite without gravity, and its coordinate."""
    factors, vectors = buckling_modes(reduction, 1)
    if len(factors) == 0:
        return float('inf'), 0
    return float(factors[0]), int(np.argmax(np.abs(vectors[:, 0])))


def buckling_modes(
    reduction: Reduction, count: int, below: float = float('inf')
) -> tuple[Floats, Floats]:
    """
    Find the modes in which the weight of a tree buckles it.

    Parameters
    ----------
    reduction
        Reduction of the tree.
    count
        Largest number of modes.
    below
        Weight over the real one [-] below which modes are wanted.

    Returns
    -------
    tuple
        Critical over real weight, ascending, (k,), and key rotations, (N, k).

    """
    from scipy import linalg

    n = reduction.n_coordinates
    softening = -reduction.gravity
    if softening.nnz == 0 or abs(softening).max() == 0.0:
        return np.zeros(0), np.zeros((n, 0))
    if n <= max(_DENSE_UP_TO, count + 1):
        values, vectors = linalg.eigh(
            softening.toarray(),
            reduction.elastic.toarray(),
            subset_by_index=[max(n - count, 0), n - 1],
        )
    else:
        factors = Factors(reduction.elastic)
        values, vectors = _largest(softening, reduction.elastic, factors, count)
    order = np.argsort(-values)
    order = order[values[order] > (1.0 / below if np.isfinite(below) else 0.0)]
    return 1.0 / values[order], vectors[:, order]


def _largest(matrix: Any, against: Any, factors: Factors, count: int) -> tuple[Floats, Floats]:
    """Find the largest ratios of a matrix to another one, and their vectors, by Lanczos."""
    from scipy.sparse import linalg as sparse_linalg

    n = matrix.shape[0]
    inverse = sparse_linalg.LinearOperator((n, n), matvec=factors.solve, dtype=np.float64)
    values, vectors = sparse_linalg.eigsh(
        matrix, k=count, M=against, Minv=inverse, which='LA', v0=np.ones(n), tol=_ENOUGH
    )
    return values, vectors


def _slowest(reduction: Reduction, count: int) -> tuple[Floats, Floats]:
    """Find ratios of mass to stiffness as `_largest`, with fewer products: mass is positive."""
    from scipy.sparse import linalg as sparse_linalg

    n = reduction.n_coordinates
    inverse = sparse_linalg.LinearOperator((n, n), matvec=reduction.factors.solve, dtype=float)
    squares, vectors = sparse_linalg.eigsh(
        reduction.stiffness, count, reduction.mass, sigma=0.0, OPinv=inverse, v0=np.ones(n),
        tol=_ENOUGH, ncv=3 * count // 2 + 20,
    )  # fmt: skip
    return 1.0 / squares, vectors / np.sqrt(squares)


def refuse_buckling(tree: Tree, reduction: Reduction) -> None:
    """Refuse, by a `TreeError`, a tree that its weight buckles, or a branch without mass."""
    diagonal = reduction.mass.diagonal()
    for coordinate in np.flatnonzero(~(diagonal > 0.0))[:1]:
        raise TreeError(
            'massless: it has a length but no mass',
            where=_branch_name(tree, reduction, int(coordinate)),
            cure='give its segments a diameter and the wood a density above 0',
        )
    if reduction.factors.is_positive:
        return
    factor, coordinate = buckling_factor(reduction)
    if factor <= 1.0:
        raise TreeError(
            f'buckles under its own weight: it could carry {100.0 * factor:.0f} % of it',
            where=_branch_name(tree, reduction, coordinate),
            cure=f'give a modulus {1.05 / factor:.2f} times as high or diameters '
            f'{factor**-0.5 * 1.03:.2f} '
            'times as thick, let its file be changed: --option thicken=yes, or leave its weight '
            'out: gravity 0, --gravity off',
        )


def _branch_name(tree: Tree, reduction: Reduction, coordinate: int) -> str:
    branch = int(np.searchsorted(reduction.first, coordinate, side='right')) - 1
    return f"branch '{tree.branch_names[branch]}'"
