# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
What a tree is at one moment, as few numbers: a basis of the key rotations, and states to keep and
set.
"""
