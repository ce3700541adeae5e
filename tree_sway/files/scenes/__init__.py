# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Scenes as files.

A YAML list of trees, a forester's table, or a YAML file that names one.
"""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway.files.scenes.classes import kind_classes as kind_classes
    from tree_sway.files.scenes.critical_winds import read_critical_winds as read_critical_winds
    from tree_sway.files.scenes.inventory.inventory_file import inventory_table as inventory_table
    from tree_sway.files.scenes.inventory.read_inventory import Inventory as Inventory
    from tree_sway.files.scenes.inventory.read_inventory import inventory_of as inventory_of
else:
    __getattr__, __dir__, __all__ = face(__name__)
