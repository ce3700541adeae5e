"""Writing a tree for a command: where, what, and a line about it."""

from __future__ import annotations

from tree_sway_ros.core.tree.species import Species
from tree_sway_ros.core.tree.tree import Tree
from tree_sway_ros.files.export.tree_export import write_tree

OUTPUT_HELP = "file to write; its suffix names the format: .yaml, .obj, .glb, .gltf"


def write_tree_file(path: str, tree: Tree, species: Species | None) -> None:
    """Write a tree and say what was written."""
    write_tree(path, tree, species)
    print(what_was_written(path, tree))


def what_was_written(path: str, tree: Tree) -> str:
    """Return a line about a tree in a file."""
    size = f"{tree.n_branches} branches, {tree.n_segments} segments, {tree.height:.2f} m"
    return f"{path}: {tree.name}, {size}"
