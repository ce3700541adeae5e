# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The tree as arrays of segments in depth-first order, and its construction.

Species are here too: wood, damping and drag by name. This room has no wind or motion.
"""
