# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Trees for other programs: YAML, glTF, USD, MJCF, SDF, OBJ; columns as CSV, JSON, Parquet.

One module a format, over a mesh (`tree_mesh`) or bodies on hinges (`hinged_tree`); animated files
sway in a breeze that is always the same.
"""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway.files.export.gltf_tree import morphing_tree as morphing_tree
    from tree_sway.files.export.hinged_tree import plain_names as plain_names
    from tree_sway.files.export.hinged_tree_writing import mjcf_of_tree as mjcf_of_tree
    from tree_sway.files.export.table_writing import refuse_no_table as refuse_no_table
    from tree_sway.files.export.table_writing import write_columns as write_columns
    from tree_sway.files.export.tree_export import write_tree as write_tree
else:
    __getattr__, __dir__, __all__ = face(__name__)
