# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Inventories of trees: rows of place, species and size, from tables of all kinds."""
