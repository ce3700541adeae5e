# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A tree on hinges as MJCF, which MuJoCo reads, and as SDF, which Gazebo and Drake read.

The rest shape is that of the tree under its own weight, so gravity is taken off its bodies.
Segments touch other things, and not each other.
"""

from __future__ import annotations

import math
from xml.etree import ElementTree

import numpy as np

from tree_sway.core.simulator.simulator import SwaySimulator
from tree_sway.files.export.hinged_tree import hinged_tree, HingedTree

_USUAL_STEP = 0.002
_ALONG_X = f'0 0 0 0 {math.sqrt(0.5):.9g} 0 {math.sqrt(0.5):.9g}'


def mjcf_of_tree(simulator: SwaySimulator) -> str:
    """Return the tree of a simulator as MJCF, MuJoCo's model file."""
    tree, hinged = simulator.tree, hinged_tree(simulator)
    root = ElementTree.Element('mujoco', model=tree.name)
    root.append(ElementTree.Comment(_comment(simulator, hinged)))
    ElementTree.SubElement(root, 'compiler', angle='radian')
    step = min(_USUAL_STEP, hinged.largest_step)
    ElementTree.SubElement(root, 'option', timestep=f'{step:g}', integrator='Euler')
    default = ElementTree.SubElement(root, 'default')
    # Bits that no segment has in common with another, and all have with what is left to default.
    ElementTree.SubElement(default, 'geom', type='capsule', contype='0', rgba='0.4 0.3 0.2 1')
    bodies = [ElementTree.SubElement(root, 'worldbody')]
    radius = 0.25 * (tree.base_diameter + tree.tip_diameter)
    for i, (name, parent) in enumerate(zip(hinged.names, tree.segment_parent, strict=True)):
        body = ElementTree.SubElement(
            bodies[parent + 1],
            'body',
            name=name,
            pos=_text(hinged.poses[i, :3]),
            quat=_text(hinged.poses[i, [6, 3, 4, 5]]),
            gravcomp='1',
        )
        ElementTree.SubElement(
            body,
            'inertial',
            pos=f'{hinged.centre[i]:.9g} 0 0',
            mass=f'{hinged.mass[i]:.9g}',
            diaginertia=_text(hinged.inertia[i, [0, 1, 1]]),
        )
        stiffness = hinged.stiffness[i]
        for axis, direction in (('y', '0 1 0'), ('z', '0 0 1')):
            ElementTree.SubElement(
                body,
                'joint',
                name=f'{name}_{axis}',
                axis=direction,
                stiffness=f'{stiffness:.9g}',
                damping=f'{hinged.damping_time * stiffness:.9g}',
            )
        reach = f'0 0 0 {tree.length[i]:.9g} 0 0'
        ElementTree.SubElement(body, 'geom', fromto=reach, size=f'{radius[i]:.9g}')
        bodies.append(body)
    return _document(root)


def sdf_of_tree(simulator: SwaySimulator) -> str:
    """Return the tree of a simulator as a model of SDF 1.9, on universal joints."""
    tree, hinged = simulator.tree, hinged_tree(simulator)
    root = ElementTree.Element('sdf', version='1.9')
    root.append(ElementTree.Comment(_comment(simulator, hinged)))
    model = ElementTree.SubElement(root, 'model', name=tree.name)
    radius = 0.25 * (tree.base_diameter + tree.tip_diameter)
    for i, (name, parent) in enumerate(zip(hinged.names, tree.segment_parent, strict=True)):
        carrier = hinged.names[parent] if parent >= 0 else '__model__'
        link = ElementTree.SubElement(model, 'link', name=name)
        _add(link, 'pose', _text(hinged.poses[i]), relative_to=carrier,
             rotation_format='quat_xyzw')  # fmt: skip
        _add(link, 'gravity', 'false')
        inertial = ElementTree.SubElement(link, 'inertial')
        _add(inertial, 'pose', f'{hinged.centre[i]:.9g} 0 0 0 0 0')
        _add(inertial, 'mass', f'{hinged.mass[i]:.9g}')
        inertia = ElementTree.SubElement(inertial, 'inertia')
        for entry, value in zip(('ixx', 'iyy', 'izz'), hinged.inertia[i, [0, 1, 1]], strict=True):
            _add(inertia, entry, f'{value:.9g}')
        for kind in ('visual', 'collision'):
            shape = ElementTree.SubElement(link, kind, name=kind)
            middle = f'{0.5 * tree.length[i]:.9g}{_ALONG_X[1:]}'
            _add(shape, 'pose', middle, rotation_format='quat_xyzw')
            geometry = ElementTree.SubElement(shape, 'geometry')
            cylinder = ElementTree.SubElement(geometry, 'cylinder')
            _add(cylinder, 'radius', f'{radius[i]:.9g}')
            _add(cylinder, 'length', f'{tree.length[i]:.9g}')
        joint = ElementTree.SubElement(model, 'joint', name=f'{name}_joint', type='universal')
        _add(joint, 'parent', carrier if parent >= 0 else 'world')
        _add(joint, 'child', name)
        for tag, direction in (('axis', '0 1 0'), ('axis2', '0 0 1')):
            axis = ElementTree.SubElement(joint, tag)
            _add(axis, 'xyz', direction)
            dynamics = ElementTree.SubElement(axis, 'dynamics')
            _add(dynamics, 'damping', f'{hinged.damping_time * hinged.stiffness[i]:.9g}')
            _add(dynamics, 'spring_reference', '0')
            _add(dynamics, 'spring_stiffness', f'{hinged.stiffness[i]:.9g}')
            limit = ElementTree.SubElement(axis, 'limit')
            _add(limit, 'lower', '-1.57')
            _add(limit, 'upper', '1.57')
    return _document(root)


def _comment(simulator: SwaySimulator, hinged: HingedTree) -> str:
    ratio, frequency = simulator.check_tuning().damping_ratio, simulator.frequencies(1)[0]
    return (
        f' {simulator.tree.name} by tree_sway: first natural frequency {frequency:.4g} Hz, damping '
        f'ratio {ratio:.3g} there and higher above. Largest stable time step '
        f'{hinged.largest_step:.3g} s by semi-implicit Euler with implicit damping. SI units. '
    )


def _add(parent: ElementTree.Element, tag: str, text: str, **attributes: str) -> None:
    ElementTree.SubElement(parent, tag, attributes).text = text


def _text(values: np.ndarray) -> str:
    return ' '.join(f'{value:.9g}' for value in values)


def _document(root: ElementTree.Element) -> str:
    ElementTree.indent(root, '')
    return ElementTree.tostring(root, encoding='unicode')
