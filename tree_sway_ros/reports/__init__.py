# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Diagnostics of solver and wind node.

Counts are from the library, levels are decided here. The hot path does not log.
"""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway_ros.reports.diagnostics import ERROR as ERROR
    from tree_sway_ros.reports.diagnostics import OK as OK
    from tree_sway_ros.reports.diagnostics import Status as Status
    from tree_sway_ros.reports.diagnostics import WARN as WARN
else:
    __getattr__, __dir__, __all__ = face(__name__)
