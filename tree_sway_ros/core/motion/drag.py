"""
What the wind does to a branch: one load centre a branch, so that cost does not depend on how finely
it is cut.

The force on a piece is ``1/2 rho Cd(U) dA |U_n| U_n``, U_n the velocity of the air relative to the
piece, across it. Summed over a branch it acts at the centre of the load, on the mean displacement
of the loaded pieces; the branch damps itself at the displacement that gives the same damping as the
sum. Crowns in leaf streamline: Cd = C U^-N (Mayhead 1973; Vollsinger et al. 2005) between 4 and 20
m/s, constant outside. Those are the speeds at which crowns were measured in wind tunnels (Rudnicki
et al. 2004; Vollsinger et al. 2005).

**Implicit in the branch's own motion.** A light twig follows the air within a fraction of a step,
where an explicit drag would shake it to pieces. With u the velocity the branch would have half a
step on without the force, and beta the velocity that a unit of force adds by then, the relative
speed s solves ``s + beta c s^2 = |U - u|`` in closed form: stable for any wind and step, second
order in the step.

"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.core.branch.beam import cross_matrix
from tree_sway_ros.core.branch.model import BranchModel
from tree_sway_ros.core.kernel import inlined
from tree_sway_ros.core.reduction.matrices import Reduction
from tree_sway_ros.core.tree.tree import Tree

AIR_DENSITY = 1.225
"""Of dry air at 15 degrees C and sea level in [kg/m^3] (ISO 2533)."""

STREAMLINING_FROM, STREAMLINING_TO = 4.0, 20.0
"""Wind speeds in [m/s] between which the drag law is measured."""


def fill_branch_loads(
    tree: Tree, models: list[BranchModel], reduction: Reduction, speed_profile: Floats, records: Any
) -> None:
    """
    Fill the fields of `BRANCH` records that the wind load reads.

    Parameters
    ----------
    tree, models, reduction
        The tree, its branches and their reduction.
    speed_profile
        Wind speed at each segment over that at the anemometer, (n,).
    records
        Of dtype `BRANCH`, (b,), written.

    """
    for b, model in enumerate(models):
        record, beam = records[b], model.beam
        record["coordinate"] = reduction.first[b]
        record["twist"] = reduction.twist[b, : len(record["twist"])]
        weight = model.drag_area * beam.weight
        total = weight.sum()
        share = weight / total
        record["centre"] = np.einsum("sg,sgk->k", share, beam.point)
        speed = float((share * speed_profile[tree.segments_of(b), None]).sum())
        record["speed"] = speed
        record["area"] = total / speed**2 if speed > 0.0 else 0.0
        along = np.einsum("sg,si,sj->ij", share, beam.tangent, beam.tangent)
        across = np.eye(3) - along
        record["projector"] = across[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]
        square = 0.0
        for i, way in enumerate(model.coordinates):
            field = way.shape.displacement(way.axis)[0]
            record["push"][i] = np.einsum("sg,sgk->k", share, field)
            record["turn"][i] = float((share * way.shape.slope).sum()) * way.axis
            square += float((share[..., None] * field**2).sum()) if i < 2 else 0.0
        record["flow"] = record["push"]
        # Both axes of the first shape as one, so that it does not matter how they are laid.
        push = float(np.square(record["push"][:2]).sum())
        record["flow"][:2] *= square / push if push > 0.0 else 1.0
        record["lever"] = math.sqrt(0.5 * push)
    _fill_axial_levers(tree, records)


def _fill_axial_levers(tree: Tree, records: Any) -> None:
    """
    How far up the parent's chord each subtree's centre of load swings: its way across on a unit of
    rotation.

    """
    area = records["area"].copy()
    moment = records["centre"] * area[:, None]
    for b in range(tree.n_branches - 1, 0, -1):
        twist, across = records[b]["twist"][:2], records[tree.branch_parent[b]]["frame"][1:]
        centre = moment[b] / area[b] if area[b] > 0.0 else records[b]["centre"]
        way = twist[:, :3] + twist[:, 3:] @ cross_matrix(centre)
        records[b]["axial_lever"] = 0.5 * float((way * across).sum())
        area[tree.branch_parent[b]] += area[b]
        moment[tree.branch_parent[b]] += moment[b]


def pressure(speed: float, coefficient: float, exponent: float) -> float:
    """
    Drag per area and speed squared, ``1/2 rho C U^-N``, in [kg/m^3].

    Parameters
    ----------
    speed
        U of the wind in [m/s].
    coefficient, exponent
        C and N of the species.

    """
    if exponent == 0.0:
        return 0.5 * AIR_DENSITY * coefficient
    streamlined = min(max(speed, STREAMLINING_FROM), STREAMLINING_TO)
    return 0.5 * AIR_DENSITY * coefficient * math.pow(streamlined, -exponent)


@inlined
def drag(
    pxx: float, pyy: float, pzz: float, pxy: float, pxz: float, pyz: float,
    c: float, compliance: float, ux: float, uy: float, uz: float,
) -> tuple[float, float, float, float]:  # fmt: skip
    """
    Force on a branch.

    Parameters
    ----------
    pxx, pyy, pzz, pxy, pxz, pyz
        Its projector.
    c
        `pressure` times its area in [kg/m].
    compliance
        Velocity half a step after a unit of force in [s/kg].
    ux, uy, uz
        Air velocity in the branch's own frame, relative to what the branch would do without this
        force, in [m/s].

    Returns
    -------
    tuple
        Force in the same frame in [N], and force per air velocity in [N s/m].

    """
    nx = pxx * ux + pxy * uy + pxz * uz
    ny = pxy * ux + pyy * uy + pyz * uz
    nz = pxz * ux + pyz * uy + pzz * uz
    free = math.sqrt(max(ux * nx + uy * ny + uz * nz, 0.0))
    relative_over_free = 2.0 / (1.0 + math.sqrt(1.0 + 4.0 * compliance * c * free))
    f = c * free * relative_over_free * relative_over_free
    return f * nx, f * ny, f * nz, f
