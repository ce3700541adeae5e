# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
What a tree is at one moment, as few numbers.

They are coordinates in a basis of the key rotations; states of them are stored and set.
"""
