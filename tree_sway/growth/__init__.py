# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Trees grown from a species, a height and a seed.

Habits, thickness, twigs; the built-in trees by name.
Nothing here knows of wind or files.
"""
