# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A tree on hinges as MJCF, which MuJoCo reads, and as SDF, which Gazebo and Drake read.

The rest shape is that of the tree under its own weight. In MJCF springs carry the weight, and wood
twists; the joints of SDF have two axes and no weight: gravity is taken off its bodies. Segments
touch other things, and not each other in MuJoCo. There the wind of the model's options moves the
tree: each segment is an ellipsoid in air with the drag of its wood and leaves.

MuJoCo's drag is ``rho C A |v| v`` without 1/2, along the air, and its area A is nearly the whole
one in oblique winds, where ours is ``|v_n| v_n`` of the air across the segment. The coefficient
gives both the same drag in the mean of all horizontal winds.
"""

from __future__ import annotations

import re
from xml.sax.saxutils import quoteattr

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.drag import AIR_DENSITY
from tree_sway.core.run import SwaySimulator
from tree_sway.core.tree import Tree
from tree_sway.files.export.hinged_tree import hinged_tree, HingedTree

_USUAL_STEP = 0.002
_BEARINGS = 12
"""Winds from half the horizon, the other half being alike, that drags are the mean of."""
_NOT_IN_XML = re.compile('[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]')

_AXES = {'y': '0 1 0', 'z': '0 0 1', 'x': '1 0 0'}
"""Axes of the hinges of a segment in its frame, in the order of `HingedTree.stiffness`."""


def mjcf_of_tree(simulator: SwaySimulator) -> str:
    """Return the tree of a simulator as MJCF, MuJoCo's model file."""
    tree = simulator.tree
    hinged = hinged_tree(simulator)
    radius = _radii(tree)
    drag = _drag_coefficients(tree, hinged.drag_area, radius)
    inside: list[list[str]] = [[] for _ in range(tree.n_segments + 1)]  # of bodies, and the world
    for i in range(tree.n_segments - 1, -1, -1):  # children come after their parents
        body = f"""\
<body name="{hinged.names[i]}" pos="{_text(hinged.poses[i, :3])}"
quat="{_text(hinged.poses[i, [6, 3, 4, 5]])}">
<inertial pos="{_text(hinged.centre[i])} 0 0" mass="{_text(hinged.mass[i])}"
diaginertia="{_text(hinged.inertia[i, [0, 1, 1]])}"/>
{_joints(hinged, i)}
<geom fromto="0 0 0 {_text(tree.length[i])} 0 0" size="{_text(radius[i])}"
fluidcoef="{_text(drag[i])} 0 0 0 0"/>"""
        text = '\n'.join([body, *reversed(inside[i]), '</body>'])
        inside[tree.segment_parent[i]].append(text)
    # Geometries collide where a bit of one is in the other's mask: segments have none.
    bodies = '\n'.join(inside[-1])
    step = min(_USUAL_STEP, hinged.largest_step)
    return f"""\
<mujoco model={_quoted(tree.name)}>
{_comment(simulator, hinged)}
<compiler angle="radian"/>
<option timestep="{step:g}" integrator="Euler" density="{AIR_DENSITY:g}" wind="0 0 0"/>
<default><geom type="capsule" contype="0" rgba="0.4 0.3 0.2 1" fluidshape="ellipsoid"/></default>
<worldbody>
{bodies}
</worldbody>
</mujoco>
"""


def sdf_of_tree(simulator: SwaySimulator) -> str:
    """Return the tree of a simulator as a model of SDF 1.9, on universal joints."""
    tree = simulator.tree
    hinged = hinged_tree(simulator, has_twist_and_weight=False)
    radius = _radii(tree)
    links = '\n'.join(_link(tree, hinged, i, radius[i]) for i in range(tree.n_segments))
    return f"""\
<sdf version="1.9">
{_comment(simulator, hinged)}
<model name={_quoted(tree.name)}>
{links}
</model>
</sdf>
"""


def _quoted(name: str) -> str:
    """Return a name as an attribute, with ``_`` for characters that XML 1.0 cannot have."""
    return quoteattr(_NOT_IN_XML.sub('_', name))


def _comment(simulator: SwaySimulator, hinged: HingedTree) -> str:
    return (
        f'<!-- A tree by tree_sway, in SI units. First natural frequency '
        f'{simulator.frequencies(1)[0]:.4g} Hz, damping ratio '
        f'{simulator.check_tuning().damping_ratio:.3g} there and higher above. Largest stable '
        f'time step {hinged.largest_step:.3g} s by semi-implicit Euler, damping implicit. -->'
    )


def _radii(tree: Tree) -> Floats:
    """Mean radius of each segment [m], (n,)."""
    return 0.25 * (tree.base_diameter + tree.tip_diameter)


def _link(tree: Tree, hinged: HingedTree, i: int, radius: float) -> str:
    """Return a segment as SDF, and the joint that it hangs on."""
    name = hinged.names[i]
    parent = tree.segment_parent[i]
    carrier = hinged.names[parent] if parent >= 0 else ''
    stiffness = hinged.stiffness[i, 0]
    place = _text(hinged.poses[i])
    turning, across = map(_text, hinged.inertia[i])
    shape = f"""\
<pose>{_text(0.5 * tree.length[i])} 0 0 0 1.5707963 0</pose>
<geometry><cylinder><radius>{_text(radius)}</radius><length>{_text(tree.length[i])}</length>
</cylinder></geometry>"""
    spring = f"""\
<limit><lower>-1.57</lower><upper>1.57</upper></limit>
<dynamics><damping>{_text(hinged.damping_time * stiffness)}</damping>
<spring_reference>0</spring_reference>
<spring_stiffness>{_text(stiffness)}</spring_stiffness></dynamics>"""
    return f"""\
<link name="{name}"><gravity>false</gravity>
<pose relative_to="{carrier or '__model__'}" rotation_format="quat_xyzw">{place}</pose>
<inertial><pose>{_text(hinged.centre[i])} 0 0 0 0 0</pose><mass>{_text(hinged.mass[i])}</mass>
<inertia><ixx>{turning}</ixx><iyy>{across}</iyy><izz>{across}</izz></inertia></inertial>
<visual name="visual">{shape}</visual>
<collision name="collision">{shape}</collision></link>
<joint name="{name}_joint" type="universal"><parent>{carrier or 'world'}</parent>
<child>{name}</child>
<axis><xyz>0 1 0</xyz>{spring}</axis>
<axis2><xyz>0 0 1</xyz>{spring}</axis2></joint>"""


def _joints(hinged: HingedTree, segment: int) -> str:
    """Return the joints of a segment as MJCF."""
    springs = zip(_AXES.items(), hinged.stiffness[segment], hinged.reference[segment], strict=True)
    return '\n'.join(
        f'<joint name="{hinged.names[segment]}_{axis}" axis="{along}" '
        f'stiffness="{_text(stiffness)}" springref="{_text(reference)}" '
        f'damping="{_text(hinged.damping_time * stiffness)}"/>'
        for (axis, along), stiffness, reference in springs
    )


def _drag_coefficients(tree: Tree, drag_area: Floats, radius: Floats) -> Floats:
    """Coefficients of MuJoCo's drag of ellipsoids, (n,), for drag areas across [m^2], (n,)."""
    bearing = np.linspace(0.0, np.pi, _BEARINGS, endpoint=False)
    cosine = tree.direction[:, :2] @ np.stack([np.cos(bearing), np.sin(bearing)])
    sine_square = np.maximum(1.0 - cosine**2, 0.0)
    side = (np.pi * radius * (0.5 * tree.length + radius))[:, None]
    end = np.pi * radius[:, None] ** 2
    numerator = side**4 * sine_square + end**4 * cosine**2
    projected = np.sqrt(numerator / (side**2 * sine_square + end**2 * cosine**2))
    ours = 0.5 * drag_area * np.mean(sine_square**1.5, axis=1)
    return ours / np.mean(projected, axis=1)


def _text(values: Floats | float) -> str:
    return ' '.join(f'{value:.9g}' for value in np.atleast_1d(values))
