# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Our own form, in YAML; see `tree_yaml`."""

from __future__ import annotations

import re

from tree_sway_ros.files.trees.tree_format import TreeFormat
from tree_sway_ros.files.trees.yaml.tree_yaml import read_yaml_tree

_KEY = re.compile(r"^\{?\s*(tree_sway|branches|segments)\s*:", re.MULTILINE)

FORMAT = TreeFormat(
    "yaml", (".yaml", ".yml", ".json"), lambda head: _KEY.search(head) is not None, read_yaml_tree
)
