# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The reference: all coordinates of a tree, under the load on every branch, as the model `full`.

It registers by the entry point group `tree_sway.models`.
"""
