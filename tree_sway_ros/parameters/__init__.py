# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Parameters of nodes: one table each, from which declaration, checks and documents come.

A refused value keeps the old one.
What a parameter does is written where it is used.
"""
