# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The state of a tree as few numbers.

They are coordinates in a basis of the key rotations.
"""
