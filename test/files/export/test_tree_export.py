import json
from pathlib import Path

import numpy as np
import pytest

from tree_sway_ros.core.tree.building import tree_from_segments
from tree_sway_ros.errors import FormatError, MissingDependencyError
from tree_sway_ros.files.export.segment_mesh import SIDES, cone_points, cone_triangles, rest_frames
from tree_sway_ros.files.export.tree_export import write_tree
from tree_sway_ros.files.trees.tree_file import read_tree, read_trees

DATA = Path(__file__).parents[1] / "data"
SOURCES = [
    *sorted(p.name for p in DATA.glob("fork.*")), "forest.treefile.txt", "seedling.yaml",
    "segments.csv",
]  # fmt: skip


@pytest.fixture
def tree():
    return read_tree(DATA / "fork.archi.csv").tree


@pytest.mark.parametrize("name", SOURCES)
def test_import_export_import_is_the_identity(tmp_path, name):
    for number, first in enumerate(read_trees(DATA / name)):
        path = tmp_path / f"{number}.yaml"
        write_tree(path, first.tree, first.species)
        again = read_tree(path)
        assert again.species == first.species
        for key, value in vars(first.tree).items():
            if key != "source_index":
                np.testing.assert_array_equal(getattr(again.tree, key), value, err_msg=key)


def test_cone_is_closed_and_faces_outward(tree):
    points, triangles = cone_points(tree, 0), cone_triangles()
    edges = np.vstack([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    assert {tuple(edge) for edge in edges} == {tuple(edge[::-1]) for edge in edges}
    a, b, c = (points[triangles[:, k]] for k in range(3))
    volume = np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6.0
    polygon = SIDES / (2.0 * np.pi) * np.sin(2.0 * np.pi / SIDES)
    assert volume == pytest.approx(polygon * tree.volume[0], rel=1e-12)


def test_rest_frames_are_rotations_along_the_segment(tree):
    frames = rest_frames(tree)
    for segment in range(tree.n_segments):
        rotation = frames[segment, :3, :3]
        np.testing.assert_allclose(rotation.T @ rotation, np.eye(3), atol=1e-12)
        assert np.linalg.det(rotation) == pytest.approx(1.0)
        tip = frames[segment] @ [tree.length[segment], 0, 0, 1]
        np.testing.assert_allclose(tip[:3], tree.end[segment], atol=1e-12)


def test_obj_has_an_object_a_segment(tmp_path, tree):
    write_tree(tmp_path / "tree.obj", tree)
    lines = (tmp_path / "tree.obj").read_text().splitlines()
    assert [line[2:] for line in lines if line.startswith("o ")] == list(tree.segment_names)
    points = np.array([line.split()[1:] for line in lines if line.startswith("v ")], dtype=float)
    assert len(points) == 2 * SIDES * tree.n_segments
    assert points[:, 2].max() == pytest.approx(tree.height, abs=0.05)
    faces = np.array([line.split()[1:] for line in lines if line.startswith("f ")], dtype=int)
    assert faces.min() == 1
    assert faces.max() == len(points)


@pytest.mark.parametrize("suffix", [".glb", ".gltf"])
def test_gltf_has_a_node_a_segment(tmp_path, tree, suffix):
    trimesh = pytest.importorskip("trimesh", reason="trimesh is not installed")
    path = tmp_path / f"tree{suffix}"
    write_tree(path, tree)
    assert list(tmp_path.iterdir()) == [path]
    scene = trimesh.load(path)
    assert set(scene.graph.nodes_geometry) == set(tree.segment_names)
    y_up = np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]])
    for segment, name in enumerate(tree.segment_names):
        matrix, _ = scene.graph[name]
        np.testing.assert_allclose(matrix[:3, 3], y_up @ tree.start[segment], atol=1e-6)
        tip = matrix @ [tree.length[segment], 0, 0, 1]
        np.testing.assert_allclose(tip[:3], y_up @ tree.end[segment], atol=1e-6)
    assert scene.bounds[1][1] == pytest.approx(tree.height, abs=0.05)


def test_gltf_nodes_can_be_animated(tmp_path, tree):
    pytest.importorskip("trimesh", reason="trimesh is not installed")
    write_tree(tmp_path / "tree.gltf", tree)
    nodes = json.loads((tmp_path / "tree.gltf").read_text())["nodes"]
    moving = [node for node in nodes if "mesh" in node]
    assert len(moving) == tree.n_segments
    assert all({"translation", "rotation"} <= set(node) for node in moving)
    assert not any("matrix" in node for node in nodes)


def test_errors(tmp_path, tree, monkeypatch):
    with pytest.raises(FormatError, match=r"cannot write '.stl'; use .yaml, .yml, .obj"):
        write_tree(tmp_path / "tree.stl", tree)
    with pytest.raises(FormatError, match="cannot be written: No such file"):
        write_tree(tmp_path / "none" / "tree.obj", tree)
    monkeypatch.setitem(__import__("sys").modules, "trimesh", None)
    with pytest.raises(MissingDependencyError, match="glTF needs trimesh; pip install trimesh"):
        write_tree(tmp_path / "tree.glb", tree)


def test_upright_and_slanted_segments_alike():
    tree = tree_from_segments([[0, 0, 0]] * 2, [[0, 0, 1], [0, 0, -1]], [0.1, 0.1], parent=[-1, 0])
    assert np.isfinite(rest_frames(tree)).all()
