"""
Memory of the hot path: one record a branch, one record a segment, one record of work a branch.

A step visits every branch once and needs all that is known of it, so what belongs to a branch lies together; a
kernel takes a record array as one argument, where each plain array costs a call about .2 us.

Frames: ``rest`` is the tree's frame at rest, its origin the root node. Positions in [m], rotations in [rad].

"""

from __future__ import annotations

import numpy as np

from tree_sway_ros.core.branch_shapes import MAX_COORDINATES, N_SHAPES, N_TWISTS

BRANCH = np.dtype(
    [
        ("parent", "i8"),  # branch it sits on, -1 for the stem
        ("seat", "i8"),  # segment it sits on, -1 for the stem
        ("first", "i8"),  # its first segment
        ("end", "i8"),  # one past its last segment
        ("coordinate", "i8"),  # its first coordinate
        ("n_coordinates", "i8"),  # pairs x, y, then twists
        ("n_pairs", "i8"),
        ("source", "i8"),  # branch whose motion it copies, itself if solved
        ("frame", "f8", (3, 3)),  # b, e1, e2 as rows; x turns about e2, y about -e1, a twist about b
        ("twist", "f8", (MAX_COORDINATES, 6)),  # motion of its base per unit of parent's coordinates
        ("push", "f8", (MAX_COORDINATES, 3)),  # displacement under the wind's mean push
        ("flow", "f8", (MAX_COORDINATES, 3)),  # displacement at which its drag damps
        ("reach", "f8", (MAX_COORDINATES, 3)),  # displacement of its tip
        ("tip", "f8", (3,)),  # tip at rest
        ("turn", "f8", (MAX_COORDINATES, 3)),  # rotation of what the wind sees
        ("lever", "f8"),  # of its own load about its base [m]
        ("axial_lever", "f8"),  # of what it carries on its parent's rotation [m]
        ("area", "f8"),  # drag area [m^2]
        ("speed", "f8"),  # wind here over wind at the anemometer
        ("compliance", "f8"),  # velocity half a step after a unit of force [s/kg]
        ("centre", "f8", (3,)),  # centre of the wind load
        ("projector", "f8", (6,)),  # mean of 1 - t t^T: xx, yy, zz, xy, xz, yz
        ("is_straight", "i8"),  # whether all its segments lie on one line
        ("steepest", "f8"),  # square of its largest slope, stretched
        ("skew", "f8"),  # third cumulant of its slope shape, over 6
        ("tip_skew", "f8"),  # the same of the tip-load shape
        ("seat_slope", "f8", (N_SHAPES + N_TWISTS,)),  # of the parent's shapes and twists at its base
        ("offset", "f8", (3,)),  # base, from its seat's start, in the seat's frame
    ]
)
"""All that a step needs to know of a branch."""

SEGMENT = np.dtype(
    [
        ("slope", "f8", (N_SHAPES + N_TWISTS,)),  # of each shape, then of each twist
        ("tip_slope", "f8"),  # of the shape under a load at the tip
        ("length", "f8"),
        ("has_gap", "i8"),  # whether the next segment starts elsewhere than this one ends
        ("gap", "f8", (3,)),  # from its end to the next one's start, at rest
        ("rest", "f8", (4,)),  # orientation at rest, w x y z
    ]
)
"""All that placing needs to know of a segment."""

WORK = np.dtype(
    [
        ("velocity", "f8", (6,)),  # of the base (v, w), about the root, in rest geometry
        ("rotation", "f8", (3,)),  # of the base, from rest
        ("force", "f8", (3,)),  # of the wind on the branch in the last step [N]
        ("slip", "f8", (3,)),  # what that force took off the relative wind, over the compliance [N]
        ("wrench", "f8", (6,)),  # force and moment about the root of all it carries
        ("base", "f8", (4,)),  # orientation of the base when placed, from rest, w x y z
    ]
)
"""What a step computes on the way, kept from one step to the next."""
