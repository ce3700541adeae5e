# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Error and cost of every number of coordinates, and the choice among them.

Estimates are made before a step is taken. The models themselves are in rooms below.
"""
