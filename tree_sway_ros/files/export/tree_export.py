"""
Write a tree for other programs: our YAML, Wavefront OBJ, glTF.

YAML is exact and reads back. OBJ and glTF hold the shape at rest, one object or node a segment,
named as in `Tree.segment_names`, so that any engine can move the nodes by the poses of the
segments. OBJ has z up, as the tree; glTF has y up by its specification, which its node ``tree``
turns: the nodes inside it keep our frame.

"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from tree_sway_ros.core.tree.species import Species
from tree_sway_ros.core.tree.tree import Tree
from tree_sway_ros.errors import FormatError, MissingDependencyError
from tree_sway_ros.files.export.segment_mesh import cone_points, cone_triangles, rest_frames
from tree_sway_ros.files.export.yaml_writing import write_yaml_tree
from tree_sway_ros.files.whole_file import whole_file

_Y_UP = np.array([[1, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]], dtype=np.float64)
_BARK = (0.36, 0.27, 0.2, 1.0)


def write_tree(path: str | Path, tree: Tree, species: Species | None = None) -> None:
    """
    Write a tree in the format of the path's suffix.

    Parameters
    ----------
    path
        The file: ``.yaml``, ``.yml``, ``.obj``, ``.glb`` or ``.gltf``; overwritten if it exists.
    tree
        The tree.
    species
        Its wood, if other than the table's; only YAML can carry it.

    Raises
    ------
    FormatError
        Another suffix, or a file that cannot be written.
    MissingDependencyError
        If glTF is asked for and trimesh is not installed.

    """
    path = Path(path)
    writers: dict[str, Callable[[Path], None]] = {
        ".yaml": lambda path: write_yaml_tree(path, tree, species),
        ".yml": lambda path: write_yaml_tree(path, tree, species),
        ".obj": lambda path: write_obj(path, tree),
        ".glb": lambda path: write_gltf(path, tree),
        ".gltf": lambda path: write_gltf(path, tree),
    }
    writer = writers.get(path.suffix.lower())
    if writer is None:
        raise FormatError(
            f"cannot write '{path.suffix}'", where=str(path), cure=f"use {', '.join(writers)}"
        )
    with whole_file(path) as partial:
        writer(partial)


def write_obj(path: Path, tree: Tree) -> None:
    """Write the shape at rest as Wavefront OBJ, one object a segment, z up, in metres."""
    frames, triangles = rest_frames(tree), cone_triangles()
    lines = [f"# {tree.name}: z up, metres".replace("\n", " ")]
    first = 1
    for segment, name in enumerate(tree.segment_names):
        points = cone_points(tree, segment) @ frames[segment, :3, :3].T + frames[segment, :3, 3]
        lines.append(f"o {'_'.join(name.split())}")
        lines += [f"v {x:.9g} {y:.9g} {z:.9g}" for x, y, z in points]
        lines += [f"f {a} {b} {c}" for a, b, c in triangles + first]
        first += len(points)
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def write_gltf(path: Path, tree: Tree) -> None:
    """
    Write the shape at rest as glTF 2.0, binary if the suffix is ``.glb``, one node a segment.

    Raises
    ------
    MissingDependencyError
        If trimesh is not installed.

    """
    try:
        import trimesh
    except ImportError as error:
        raise MissingDependencyError(
            "glTF needs trimesh", where=str(path), cure="pip install trimesh"
        ) from error
    scene = trimesh.Scene(base_frame="world")
    scene.graph.update(frame_from="world", frame_to="tree", matrix=_Y_UP)
    triangles = cone_triangles()
    bark = trimesh.visual.TextureVisuals(
        material=trimesh.visual.material.PBRMaterial(
            name="bark", baseColorFactor=_BARK, metallicFactor=0.0, roughnessFactor=1.0
        )
    )
    for segment, (name, frame) in enumerate(
        zip(tree.segment_names, rest_frames(tree), strict=True)
    ):
        mesh = trimesh.Trimesh(cone_points(tree, segment), triangles, process=False, visual=bark)
        scene.add_geometry(
            mesh, node_name=name, geom_name=name, parent_node_name="tree", transform=frame
        )
    gltf: Any = trimesh.exchange.gltf
    if path.suffix.lower() == ".glb":
        path.write_bytes(gltf.export_glb(scene, tree_postprocessor=_split_matrices))
        return
    files = gltf.export_gltf(
        scene, merge_buffers=True, embed_buffers=True, tree_postprocessor=_split_matrices
    )
    path.write_bytes(files["model.gltf"])


def _split_matrices(gltf: dict[str, Any]) -> None:
    """Give nodes translation and rotation for their matrix, as only those can be animated."""
    for node in gltf["nodes"]:
        if "matrix" in node:
            matrix = np.array(node.pop("matrix")).reshape(4, 4).T
            node["translation"] = matrix[:3, 3].tolist()
            node["rotation"] = Rotation.from_matrix(matrix[:3, :3]).as_quat().tolist()
