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

METHODS: dict[str, type[Method]] = {
    kind.name: kind
    for kind in (
        MultiplierExplicitEuler, MultiplierRungeKutta4, Baumgarte, Projection, Rattle,
        LinearlyImplicitEuler, Newmark, GeneralizedAlpha, RadauGgl,
        SemiImplicitEuler, Verlet, RungeKutta4, ImplicitMidpoint, TrBdf2, Bdf2,
        ExactZeroOrderHold, ExactFirstOrderHold, ExactAboutEquilibrium,
    )
}  # fmt: skip


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
