# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What the page on Blender says of an imported tree, where Blender is installed as a module."""

from __future__ import annotations

from pathlib import Path
import re
from textwrap import dedent

import pytest

from tree_sway.commands.cli import main

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / 'doc' / 'integrate.md'
SEEDLING = ROOT / 'test' / 'files' / 'data' / 'seedling.yaml'


def test_its_script_lets_every_shape_sway_both_ways(tmp_path: Path) -> None:
    bpy = pytest.importorskip('bpy', reason='needs Blender as a module (pip install bpy)')
    path = tmp_path / 'tree.glb'
    assert main(['convert', str(SEEDLING), '--sway', 'morph', '-o', str(path)]) == 0
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=str(path))
    (mesh,) = [each for each in bpy.data.objects if each.type == 'MESH']
    top = max((mesh.matrix_world @ vertex.co).z for vertex in mesh.data.vertices)
    assert top == pytest.approx(0.9, rel=0.02)  # z up, metres
    (script,) = re.findall(r'^   ```py\n(.*?)^   ```', PAGE.read_text(), re.MULTILINE | re.DOTALL)
    exec(compile(dedent(script), PAGE.name, 'exec'), {})
    keys = mesh.data.shape_keys
    assert keys.animation_data.action.name == 'breeze'
    curves = [
        curve
        for layer in keys.animation_data.action.layers
        for strip in layer.strips
        for bag in strip.channelbags
        for curve in bag.fcurves
    ]
    assert len(curves) == len(keys.key_blocks) - 1
    least = 0.0
    for frame in range(0, bpy.context.scene.frame_end, 40):
        bpy.context.scene.frame_set(frame)
        for curve, key in zip(curves, keys.key_blocks[1:], strict=True):
            assert key.value == pytest.approx(curve.evaluate(frame), abs=1e-6)
            least = min(least, key.value)
    assert least < 0.0
