# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A measured sway, and a tree that sways so.

`estimate_sway` finds frequency and damping of a tree that was pulled and released, from a record
of its motion (`free_decay`); `calibrate` scales its wood until it has that frequency.
"""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway.identification.calibration import calibrate as calibrate
    from tree_sway.identification.measured_sway import estimate_sway as estimate_sway
else:
    __getattr__, __dir__, __all__ = face(__name__)
