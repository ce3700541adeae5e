# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Parameters of nodes: one table each, from which declaration, checks and documents come.

After a refusal the old value stays. The meaning of a parameter is in the module that uses it.
"""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway_ros.parameters.annexes import ANNEXES as ANNEXES
    from tree_sway_ros.parameters.node_parameters import NODE_PARAMETERS as NODE_PARAMETERS
else:
    __getattr__, __dir__, __all__ = face(__name__)
