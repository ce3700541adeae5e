# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Cards of leaves: those of files are those of the page."""

import base64
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from tree_sway.core.scene.make import make_simulator
from tree_sway.core.species.species import species_named
from tree_sway.files.export.tree_mesh import leaf_mesh
from tree_sway.growth.builtin import builtin_tree
from tree_sway.stream.scene_state import SceneState

STATIC = Path(__file__).parents[2] / 'tree_sway' / 'page' / 'static'


def test_cards_are_those_of_the_page(javascript: Callable[..., Any]) -> None:
    """`leafMesh` of the page has the same corners, in the frames of its segments."""
    tree = builtin_tree('goldcrest', 0)
    simulator = make_simulator(tree, species_named('goldcrest'), model=12)
    scene = SceneState(simulator, 40)
    (leaves,), spray = scene.leaves, species_named('goldcrest').look.spray
    assert leaves is not None
    ours = leaf_mesh(leaves, spray, 3)
    program = f"""
      import {{ readFileSync }} from "node:fs";
      import {{ leafMesh }} from "{STATIC}/drawing/foliage.js";
      import {{ shapeOf }} from "{STATIC}/drawing/mesh.js";
      import {{ decodeDescription }} from "{STATIC}/protocol.js";
      const bytes = Buffer.from(readFileSync(0, "utf8"), "base64");
      const buffer = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength);
      const shape = shapeOf(decodeDescription(buffer).kinds[0]);
      const {{ mesh: {{ values }} }} = leafMesh(shape, shape.placer.order, 120, 120);
      const rows = [];
      for (let v = 0; v < values.length; v += 19) {{
        rows.push([...values.slice(v, v + 4), ...values.slice(v + 17, v + 19)]);
      }}
      console.log(JSON.stringify({{ rows, slots: Array.from(shape.placer.slots) }}));
    """
    page = javascript(program, base64.b64encode(scene.description).decode())
    rows, slots = np.array(page['rows']), np.array(page['slots'])
    mine = np.column_stack([slots[ours.segment], ours.points, ours.texture])
    for side in (rows, mine):
        side[:] = side[np.lexsort(side.round(5).T)]
    np.testing.assert_allclose(rows, mine, atol=2e-5)
