# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A tree by name or by path: scans, skeletons, grown descriptions, prepared models.

`open_tree` and `open_scene` are what commands, nodes and programs call. `TreeFile` is a tree with
its species, its notes and what was changed; a format is one module of `formats`, `cylinders` or
`yaml`. A tree that is described is never changed unless asked.
"""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway.files.trees.conifer_sway import sway_oddity as sway_oddity
    from tree_sway.files.trees.imported_tree import TreeFile as TreeFile
    from tree_sway.files.trees.learned_file import LearnedFile as LearnedFile
    from tree_sway.files.trees.learned_file import refuse_no_learned_file as refuse_no_learned_file
    from tree_sway.files.trees.source import open_scene as open_scene
    from tree_sway.files.trees.source import open_tree as open_tree
    from tree_sway.files.trees.source import scene_of_files as scene_of_files
    from tree_sway.files.trees.source import unknown_tree as unknown_tree
    from tree_sway.files.trees.tree_formats import TREE_FORMATS as TREE_FORMATS
    from tree_sway.files.trees.tree_options import FITTED as FITTED
else:
    __getattr__, __dir__, __all__ = face(__name__)
