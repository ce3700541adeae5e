# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Scenes as files: YAML lists of trees, forests and stands, inventories of any city.

An inventory becomes trees of a few classes that share their grown forms (`kind_classes`).
"""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway.files.kinds import expected as expected
    from tree_sway.files.scenes.classes import kind_classes as kind_classes
    from tree_sway.files.scenes.critical_winds import read_critical_winds as read_critical_winds
    from tree_sway.files.scenes.inventory.inventory_file import inventory_table as inventory_table
    from tree_sway.files.scenes.inventory.read_inventory import Inventory as Inventory
    from tree_sway.files.scenes.inventory.read_inventory import inventory_of as inventory_of
else:
    __getattr__, __dir__, __all__ = face(__name__)
