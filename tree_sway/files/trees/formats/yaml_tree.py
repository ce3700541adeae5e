# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Our own form, in YAML; see `tree_yaml`."""

from __future__ import annotations

from tree_sway.files.file_format import contains, FileFormat
from tree_sway.files.trees.yaml.tree_yaml import read_yaml_tree
from tree_sway.files.yaml_document import YAML_SUFFIXES

_KEY = contains(r'^\{?\s*(tree_sway|branches|segments)\s*:')
FORMAT = FileFormat('yaml', YAML_SUFFIXES, _KEY, read_yaml_tree)
