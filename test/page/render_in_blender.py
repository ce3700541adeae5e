# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Render a tree file in Blender, by a Python that has bpy: ``pip install bpy``.

python test/page/render_in_blender.py oak.glb oak.png
"""

import argparse
import importlib
import math
import os
from typing import Any

FRAME, SAMPLES, SIZE = 60, 16, 480
"""Frame of the animation, samples of a pixel, and width and height of the picture [px]."""

AZIMUTH, SUN = -0.6, (-0.7, -0.3, -0.648)
"""Those of the page: where the camera stands [rad], and the way of the sun's light."""


def render(file: str, picture: str) -> None:
    """Render a file on a lawn, as the page sees it at first."""
    bpy: Any = importlib.import_module('bpy')
    mathutils: Any = importlib.import_module('mathutils')
    vector = mathutils.Vector
    bpy.ops.wm.read_factory_settings(use_empty=True)
    if file.endswith('.glb'):
        bpy.ops.import_scene.gltf(filepath=file)
    else:
        bpy.ops.wm.usd_import(filepath=file)
    meshes = [each for each in bpy.data.objects if each.type == 'MESH']
    corners = [each.matrix_world @ vector(corner) for each in meshes for corner in each.bound_box]
    low, high = (vector([of(p[c] for p in corners) for c in range(3)]) for of in (min, max))
    tall = high.z - low.z
    middle = 0.5 * (low + high)
    scene, place = bpy.context.scene, bpy.context.collection.objects.link

    far = 2.2 * max(tall, high.x - low.x, high.y - low.y)
    camera = bpy.data.objects.new('camera', bpy.data.cameras.new('camera'))
    camera.data.lens = 55
    camera.location = (
        middle.x + far * math.cos(AZIMUTH),
        middle.y + far * math.sin(AZIMUTH),
        low.z + 0.35 * tall,
    )
    camera.rotation_euler = (middle - camera.location).to_track_quat('-Z', 'Y').to_euler()
    place(camera)
    sun = bpy.data.objects.new('sun', bpy.data.lights.new('sun', 'SUN'))
    sun.data.energy = 4.0
    sun.rotation_euler = vector(SUN).to_track_quat('-Z', 'Y').to_euler()
    place(sun)
    scene.world = bpy.data.worlds.new('sky')
    scene.world.use_nodes = True
    sky = scene.world.node_tree.nodes['Background'].inputs
    sky[0].default_value, sky[1].default_value = (0.55, 0.68, 0.85, 1.0), 0.8
    bpy.ops.mesh.primitive_plane_add(size=400, location=(middle.x, middle.y, low.z))
    lawn = bpy.data.materials.new('lawn')
    lawn.use_nodes = True
    lawn.node_tree.nodes['Principled BSDF'].inputs[0].default_value = (0.12, 0.17, 0.05, 1.0)
    bpy.context.object.data.materials.append(lawn)

    scene.camera = camera
    scene.render.engine = 'CYCLES'
    scene.cycles.samples, scene.cycles.device = SAMPLES, 'CPU'
    scene.cycles.transparent_max_bounces = 16
    scene.render.resolution_x = scene.render.resolution_y = SIZE
    scene.render.filepath = picture
    scene.view_settings.view_transform = 'Standard'
    scene.frame_set(FRAME)
    bpy.ops.render.render(write_still=True)


if __name__ == '__main__':
    parser = argparse.ArgumentParser()
    parser.add_argument('file')
    parser.add_argument('picture')
    given = parser.parse_args()
    render(given.file, given.picture)
    # bpy 5.0 crashes as the interpreter ends, when the picture is written.
    os._exit(0 if os.path.exists(given.picture) else 1)
