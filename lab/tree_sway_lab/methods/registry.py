# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""All methods of integration by name."""

from __future__ import annotations

from tree_sway.errors import ParameterError
from tree_sway_lab.methods.method import Method
from tree_sway_lab.methods.minimal.bdf2 import Bdf2
from tree_sway_lab.methods.minimal.exact_about_equilibrium import ExactAboutEquilibrium
from tree_sway_lab.methods.minimal.exact_foh import ExactFirstOrderHold
from tree_sway_lab.methods.minimal.exact_zoh import ExactZeroOrderHold
from tree_sway_lab.methods.minimal.implicit_midpoint import ImplicitMidpoint
from tree_sway_lab.methods.minimal.rk4 import RungeKutta4
from tree_sway_lab.methods.minimal.semi_implicit_euler import SemiImplicitEuler
from tree_sway_lab.methods.minimal.tr_bdf2 import TrBdf2
from tree_sway_lab.methods.minimal.verlet import Verlet
from tree_sway_lab.methods.multiplier.baumgarte import Baumgarte
from tree_sway_lab.methods.multiplier.explicit_euler import MultiplierExplicitEuler
from tree_sway_lab.methods.multiplier.generalized_alpha import GeneralizedAlpha
from tree_sway_lab.methods.multiplier.linearly_implicit_euler import LinearlyImplicitEuler
from tree_sway_lab.methods.multiplier.newmark import Newmark
from tree_sway_lab.methods.multiplier.projection import Projection
from tree_sway_lab.methods.multiplier.radau_ggl import RadauGgl
from tree_sway_lab.methods.multiplier.rattle import Rattle
from tree_sway_lab.methods.multiplier.rk4 import MultiplierRungeKutta4

KINDS: tuple[type[Method], ...] = (
    # On the paper's coordinates, with multipliers:
    MultiplierExplicitEuler,  # its failure at w h = 0.1 is shown (T1)
    MultiplierRungeKutta4,  # the paper's form without stabilisation: its drift is shown (T3)
    Baumgarte,  # the usual stabilisation: the limits of its gains are shown (T4)
    Projection,  # the usual cure of the drift, whose rest is measured (T3); gives reactions
    Rattle,  # the symplectic method of molecular dynamics, of which Verlet is the free form
    LinearlyImplicitEuler,  # what games use: the damping that it adds is shown (T2)
    Newmark,  # what structural dynamics uses: its failure on index 3 is shown (T1)
    GeneralizedAlpha,  # its cure; its failures at small steps and poor starts are shown (T5, T6)
    RadauGgl,  # the reference of all others
    # On angles:
    SemiImplicitEuler,  # the unit of cost; its failures are shown (T1, T18)
    Verlet,  # its failures are shown (T15, T18)
    RungeKutta4,  # the best for small steps; its failures are shown (T1, T15, T18)
    ImplicitMidpoint,  # implicit, keeps the energy: the frequency that it loses is in models.md
    TrBdf2,  # implicit, damps what it does not resolve, in one step
    Bdf2,  # the same with a memory, as the solvers of libraries have
    ExactZeroOrderHold,  # the cheapest one
    ExactFirstOrderHold,  # the one in use
    ExactAboutEquilibrium,  # the one for loads of many times the stiffness
)
"""Every method of integration, and beside it the reason why it is here."""

METHODS: dict[str, type[Method]] = {kind.name: kind for kind in KINDS}


def method_named(name: str) -> Method:
    """
    Return any method by name, with its default options.

    Raises
    ------
    ParameterError
        A name that no method has.

    """
    if name not in METHODS:
        raise ParameterError(
            f'unknown integrator {name!r}',
            where='integrator',
            cure='take one of ' + ', '.join(METHODS),
        )
    return METHODS[name]()
