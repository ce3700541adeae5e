# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Parameters, each once: default, unit, range, source.

Tables in YAML (``sway.yaml`` here, ``nodes.yaml`` of the nodes) from which commands, nodes and the
documentation take their values.
"""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway.parameters.parameter import Parameter as Parameter
    from tree_sway.parameters.parameter import read_tables as read_tables
    from tree_sway.parameters.parameter import Table as Table
    from tree_sway.parameters.parameter import Value as Value
    from tree_sway.parameters.sway_parameters import SWAY as SWAY
else:
    __getattr__, __dir__, __all__ = face(__name__)
