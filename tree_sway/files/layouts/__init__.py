# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Layouts of tables of wind: each module brings one into a table with a column a quantity."""
