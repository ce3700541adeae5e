"""All methods by name, and the check that a method stands the step it is asked for."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

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
from tree_sway_ros.core.oscillators import fill_propagator
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

REAL_TIME = tuple(name for name, kind in METHODS.items() if kind.real_time)


def method_named(name: str) -> Method:
    """
    Return any method by name, with its default options.

    Raises
    ------
    ParameterError
        A name that no method has.

    """
    if name not in METHODS:
        raise ParameterError(f"unknown integrator {name!r}", where="integrator",
                             cure="take one of " + ", ".join(METHODS))
    return METHODS[name]()


def growth(method: Method, ratio: float, damping_ratio: float) -> float:
    """Return the largest factor [-] by which one step of w h can multiply free motion."""
    row = method.propagator(
        np.array([1.0]), np.array([2.0 * damping_ratio * ratio]), np.array([ratio * ratio]), 1.0
    )[0]
    return float(np.max(np.abs(np.linalg.eigvals(row[[0, 1, 4, 5]].reshape(2, 2)))))


def stability_limit(method: Method, damping_ratio: float = 0.0) -> float:
    """
    Largest w h [-] at which free motion does not grow, infinite where every step is stable.

    Parameters
    ----------
    method
        A real-time method.
    damping_ratio
        Of the oscillator [-].

    Returns
    -------
    float
        The first crossing, found by a scan and bisection on the method's own step.

    """
    slack = 1.0 + 1e-9
    scan = np.geomspace(1e-2, 1e4, 600)
    unstable = next((w for w in scan if not growth(method, w, damping_ratio) <= slack), None)
    if unstable is None:
        return float(np.inf)
    low, high = unstable / (scan[1] / scan[0]), unstable
    for _ in range(50):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if growth(method, middle, damping_ratio) <= slack else (low, middle)
    return float(low)


def integrator_named(
    name: str, inertia: ArrayLike | None = None, damping: ArrayLike = 0.0,
    stiffness: ArrayLike = 0.0, dt: float = 1.0 / 60.0,
) -> Method:  # fmt: skip
    """
    Return a method that the solver can run, after a check that it stands the step.

    Parameters
    ----------
    name
        One of `REAL_TIME`.
    inertia, damping, stiffness
        Oscillators it will run, I [kg m^2], k2 [N m s], k1 [N m], (n,); not checked if left out.
    dt
        Time step in [s].

    Returns
    -------
    Method
        Its ``propagator(inertia, damping, stiffness, dt)`` gives the coefficients of its own step.

    Raises
    ------
    ParameterError
        An unknown name, a method that is not real-time capable, or a step beyond its limit: the first
        oscillator that would grow, its w h and the limit at its damping.

    """
    method = method_named(name)
    if not method.real_time:
        raise ParameterError(f"integrator {name!r} is not real-time capable", where="integrator",
                             cure="take one of " + ", ".join(REAL_TIME))
    if inertia is None or name.startswith("exact"):
        return method
    i, c, k = np.broadcast_arrays(*(np.atleast_1d(np.asarray(a, float))
                                    for a in (inertia, damping, stiffness)))
    rows = method.propagator(i, c, k, dt)
    square = rows[:, [0, 1, 4, 5]].reshape(-1, 2, 2)
    finite = np.isfinite(square).all((1, 2))
    radius = np.full(len(rows), np.inf)
    radius[finite] = np.abs(np.linalg.eigvals(square[finite])).max(1)
    bad = np.flatnonzero(~(radius <= 1.0 + 1e-9))
    if not len(bad):
        return method
    first = int(bad[np.argmax(k[bad] / np.maximum(i[bad], 1e-300))])
    w = float(np.sqrt(k[first] / i[first])) if i[first] > 0 else float(np.inf)
    ratio = float(c[first] / (2.0 * np.sqrt(k[first] * i[first]))) if k[first] * i[first] > 0 else 0.0
    limit = stability_limit(method, ratio)
    raise ParameterError(
        f"integrator {name!r} is unstable for oscillator {first}: w h is {w * dt:.3g}, its limit "
        f"{limit:.3g} at damping ratio {ratio:.3g}", where="integrator",
        cure=f"take {DEFAULT}, or a step below {limit / w:.2g} s" if w > 0 else f"take {DEFAULT}",
    )


def fill_steps(
    name: str, inertia: NDArray[np.float64], damping: NDArray[np.float64],
    stiffness: NDArray[np.float64], dt: float, out: NDArray[np.float64],
) -> None:  # fmt: skip
    """
    Fill the coefficients of a method's step for a bank of oscillators; no allocation for the default.

    Parameters
    ----------
    name
        One of `REAL_TIME`.
    inertia, damping, stiffness
        I [kg m^2], k2 [N m s], k1 [N m], (n,).
    dt
        Time step in [s].
    out
        Coefficients, (n, 8), written.

    Raises
    ------
    ParameterError
        As `integrator_named`.

    """
    if name == DEFAULT:
        fill_propagator(inertia, damping, stiffness, dt, out)
    else:
        method = integrator_named(name, inertia, damping, stiffness, dt)
        out[:] = method.propagator(inertia, damping, stiffness, dt)
