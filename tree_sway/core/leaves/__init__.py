# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Leaves: traits of a species, mass and area per branch, places and flutter.

Arrays per branch or per leaf.
Drag of leaves in wind is in ``motion/drag``.
"""
