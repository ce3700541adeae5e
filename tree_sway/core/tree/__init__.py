# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The tree as arrays of segments in depth-first order, and what makes one.

Species live here too: wood, damping and drag by name.
Nothing here knows of wind or motion.
"""
