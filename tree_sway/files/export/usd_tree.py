# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A tree as USD text: a skeleton with a joint per segment, and ten seconds of its sway in a breeze.

Joints of a branch are a chain, below the joint of the parent segment. For Unreal's wind the
skeleton has the attributes of ``DynamicWindSkeletonAPI`` (plugin DynamicWind, 5.7): joints are
grouped by the order of their branch, and the influence of a group is the own bending of its
branches in a steady wind, over that of the group that bends most.
"""

from __future__ import annotations

import json

import numpy as np
from scipy.spatial.transform import Rotation

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.leaves import LeafClusters
from tree_sway.core.run import SwaySimulator
from tree_sway.core.tree import Tree
from tree_sway.files.export.breeze import in_breeze, RATE, SECONDS, SPEED
from tree_sway.files.export.hinged_tree import plain_name, plain_names, poses_on_parents
from tree_sway.files.export.tree_mesh import matrices_of
from tree_sway.files.export.tree_parts import parts_of, TreePart

_STEADY = 8.0
_SETTLED = 30.0
_MAX_GROUPS = 4
_SHOOTS = 4
"""Shoots per cluster of leaves."""


def usd_of_tree(
    simulator: SwaySimulator,
    leaves: LeafClusters | None,
    pictures: str = '',
    speed: float = SPEED,
) -> str:
    """
    Return the tree of a simulator as ``.usda``, with or without leaves, in a mean wind [m/s].

    The files of its pictures are beside it, named ``bark.png`` and ``leaves.png`` behind what
    those of ``pictures`` begin with.
    The simulator is run, and then set back to the state that it was in.
    """
    tree = simulator.tree
    frames = in_breeze(
        simulator,
        SECONDS['.usda'],
        lambda: poses_on_parents(tree, simulator.place()),
        speed,
    )
    rest = tree.rest_poses
    name = plain_name(tree.name)
    parts = parts_of(tree, leaves, _SHOOTS)
    joints = json.dumps(_paths(tree))
    turns = (_tuples(frame[:, [6, 3, 4, 5]], '%.4f') for frame in frames)
    samples = '\n'.join(f'{number}: {turn},' for number, turn in enumerate(turns))
    materials = '\n'.join(_material(part, pictures, name) for part in parts)
    meshes = '\n'.join(_mesh(part, rest, name) for part in parts)
    # A segment has a fixed place on its parent, and rotates there.
    return f"""\
#usda 1.0
(
    defaultPrim = "{name}"
    upAxis = "Z"
    metersPerUnit = 1
    timeCodesPerSecond = {RATE}
    startTimeCode = 0
    endTimeCode = {len(frames) - 1}
)

def SkelRoot "{name}" (prepend apiSchemas = ["SkelBindingAPI"])
{{
def Skeleton "Skeleton" (prepend apiSchemas = ["SkelBindingAPI", "DynamicWindSkeletonAPI"])
{{
uniform token[] joints = {joints}
uniform matrix4d[] bindTransforms = {_tuples(matrices_of(rest), '%.7g')}
uniform matrix4d[] restTransforms = {_tuples(matrices_of(poses_on_parents(tree, rest)), '%.7g')}
rel skel:animationSource = </{name}/Sway>
{_wind_attributes(simulator)}
}}
def SkelAnimation "Sway"
{{
uniform token[] joints = {joints}
float3[] translations = {_tuples(frames[0][:, :3])}
half3[] scales = {_tuples(np.ones((tree.n_segments, 3)))}
quatf[] rotations.timeSamples = {{
{samples}
}}
}}
def Scope "Looks"
{{
{materials}
}}
{meshes}
}}
"""


def _paths(tree: Tree) -> list[str]:
    """Name each joint by its path from the root."""
    paths: list[str] = []
    for name, parent in zip(plain_names(tree), tree.segment_parent.tolist(), strict=True):
        paths.append(f'{paths[parent]}/{name}' if parent >= 0 else name)
    return paths


def branch_groups(tree: Tree) -> Ints:
    """Group of each segment, (n,): 0 the stem, 1 branches on it, and so on."""
    order = np.zeros(tree.n_branches, dtype=np.int64)
    for branch, parent in enumerate(tree.branch_parent.tolist()):
        order[branch] = order[parent] + 1 if parent >= 0 else 0
    return np.minimum(order, _MAX_GROUPS - 1)[tree.branch_of_segment]


def influences(simulator: SwaySimulator) -> Floats:
    """Own rotation of the branches' tips in a steady wind by groups, over the largest, (g,)."""
    tree = simulator.tree
    before = simulator.state()
    dt = 1.0 / 60.0
    simulator.reset()
    for _ in range(round(_SETTLED / dt)):
        simulator.step((_STEADY, 0.0, 0.0), dt)
    steady = Rotation.from_quat(simulator.place()[:, 3:])
    simulator.set_state(before)
    turned = steady * Rotation.from_quat(tree.rest_poses[:, 3:]).inv()
    first = tree.branch_first[:-1]
    last = tree.branch_first[1:] - 1
    carrier = tree.segment_parent[first]
    own = turned[np.maximum(carrier, 0)].inv() * turned[last]
    slope = np.where(carrier < 0, turned[last].magnitude(), own.magnitude())
    groups = branch_groups(tree)[first]
    mean = np.sqrt(np.bincount(groups, slope**2) / np.bincount(groups))
    return mean / mean.max()


def _wind_attributes(simulator: SwaySimulator) -> str:
    found = influences(simulator)
    return f"""\
uniform token[] unreal:dynamicWind:jointNames = {json.dumps(plain_names(simulator.tree))}
uniform int[] unreal:dynamicWind:jointSimulationGroups = {branch_groups(simulator.tree).tolist()}
uniform float[] unreal:dynamicWind:simulationGroupInfluences = {found.round(4).tolist()}
uniform float[] unreal:dynamicWind:simulationGroupShiftTops = {[0.0] * len(found)}
uniform int[] unreal:dynamicWind:trunkSimulationGroups = [0]
uniform bool unreal:dynamicWind:isGroundCover = false
uniform float unreal:dynamicWind:gustAttenuation = 0.0"""


def _mesh(part: TreePart, poses: Floats, root: str) -> str:
    """Write a mesh whose vertices move with one joint each."""
    mesh = part.mesh
    points = mesh.placed(poses)
    one_each = 'elementSize = 1\n    interpolation = "vertex"'
    return f"""\
def Mesh "{part.name}" (prepend apiSchemas = ["SkelBindingAPI", "MaterialBindingAPI"])
{{
rel material:binding = </{root}/Looks/{part.name}>
float3[] extent = {_tuples(np.array([points.min(axis=0), points.max(axis=0)]))}
bool doubleSided = {int(not part.is_wood)}
uniform token subdivisionScheme = "none"
int[] faceVertexCounts = {[3] * len(mesh.triangles)}
int[] faceVertexIndices = {mesh.triangles.ravel().tolist()}
point3f[] points = {_tuples(points)}
normal3f[] normals = {_tuples(mesh.turned(poses))} (interpolation = "vertex")
texCoord2f[] primvars:st = {_tuples(mesh.texture)} (interpolation = "vertex")
color3f[] primvars:displayColor = {_tuples(np.array([part.color]))}
int[] primvars:skel:jointIndices = {mesh.segment.tolist()} ({one_each})
float[] primvars:skel:jointWeights = {[1] * len(mesh.segment)} ({one_each})
rel skel:skeleton = </{root}/Skeleton>
}}"""


def _material(part: TreePart, pictures: str, root: str) -> str:
    """Write a surface with a picture times a colour, cut out by its alpha for leaves."""
    here = f'/{root}/Looks/{part.name}'
    opacity = f"""
float inputs:opacity.connect = <{here}/Picture.outputs:a>
float inputs:opacityThreshold = 0.2"""
    return f"""\
def Material "{part.name}"
{{
token outputs:surface.connect = <{here}/Surface.outputs:surface>
def Shader "Surface"
{{
uniform token info:id = "UsdPreviewSurface"
color3f inputs:diffuseColor.connect = <{here}/Picture.outputs:rgb>{opacity * (not part.is_wood)}
float inputs:roughness = 1
token outputs:surface
}}
def Shader "Picture"
{{
uniform token info:id = "UsdUVTexture"
asset inputs:file = @{pictures}{part.material}.png@
float4 inputs:scale = {(*part.linear_tint, 1)}
float2 inputs:st.connect = <{here}/Place.outputs:result>
token inputs:wrapS = "repeat"
token inputs:wrapT = "repeat"
float3 outputs:rgb
float outputs:a
}}
def Shader "Place"
{{
uniform token info:id = "UsdPrimvarReader_float2"
string inputs:varname = "st"
float2 outputs:result
}}
}}"""


def _tuples(values: Floats, number: str = '%.5g') -> str:
    """Write an array of tuples of numbers, or of tuples of such tuples."""
    form = number
    for size in values.shape[:0:-1]:
        form = f'({", ".join([form] * size)})'
    return f'[{", ".join([form] * len(values))}]' % tuple(values.ravel().tolist())
