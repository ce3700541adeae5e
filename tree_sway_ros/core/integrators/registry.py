"""All methods by name, and the check that a method stands the step it is asked for."""

from __future__ import annotations

import numpy as np

from tree_sway_ros.core.integrators.chain import PlanarChain
from tree_sway_ros.core.integrators.method import Method
from tree_sway_ros.core.integrators.minimal.bdf2 import Bdf2
from tree_sway_ros.core.integrators.minimal.exact_about_equilibrium import ExactAboutEquilibrium
from tree_sway_ros.core.integrators.minimal.exact_foh import ExactFirstOrderHold
from tree_sway_ros.core.integrators.minimal.exact_zoh import ExactZeroOrderHold
from tree_sway_ros.core.integrators.minimal.exponential_rosenbrock import ExponentialRosenbrock
from tree_sway_ros.core.integrators.minimal.implicit_midpoint import ImplicitMidpoint
from tree_sway_ros.core.integrators.minimal.rk4 import RungeKutta4
from tree_sway_ros.core.integrators.minimal.semi_implicit_euler import SemiImplicitEuler
from tree_sway_ros.core.integrators.minimal.tr_bdf2 import TrBdf2
from tree_sway_ros.core.integrators.minimal.verlet import Verlet
from tree_sway_ros.core.integrators.multiplier.baumgarte import Baumgarte
from tree_sway_ros.core.integrators.multiplier.bdf2 import MultiplierBdf2
from tree_sway_ros.core.integrators.multiplier.explicit_euler import MultiplierExplicitEuler
from tree_sway_ros.core.integrators.multiplier.generalized_alpha import GeneralizedAlpha
from tree_sway_ros.core.integrators.multiplier.hht import Hht
from tree_sway_ros.core.integrators.multiplier.implicit_midpoint import MultiplierImplicitMidpoint
from tree_sway_ros.core.integrators.multiplier.linearly_implicit_euler import LinearlyImplicitEuler
from tree_sway_ros.core.integrators.multiplier.newmark import Newmark
from tree_sway_ros.core.integrators.multiplier.projection import Projection
from tree_sway_ros.core.integrators.multiplier.radau_ggl import RadauGgl
from tree_sway_ros.core.integrators.multiplier.rattle import Rattle
from tree_sway_ros.core.integrators.multiplier.rk4 import MultiplierRungeKutta4
from tree_sway_ros.core.integrators.multiplier.semi_implicit_euler import (
    MultiplierSemiImplicitEuler,
)
from tree_sway_ros.errors import ParameterError

DEFAULT = "exact_foh"

METHODS: dict[str, type[Method]] = {
    kind.name: kind
    for kind in (
        MultiplierExplicitEuler, MultiplierSemiImplicitEuler, MultiplierRungeKutta4, Baumgarte,
        Projection, Rattle, LinearlyImplicitEuler, MultiplierImplicitMidpoint, Newmark, Hht,
        GeneralizedAlpha, MultiplierBdf2, RadauGgl,
        SemiImplicitEuler, Verlet, RungeKutta4, ImplicitMidpoint, TrBdf2, Bdf2,
        ExactZeroOrderHold, ExactFirstOrderHold, ExponentialRosenbrock, ExactAboutEquilibrium,
    )
}  # fmt: skip
