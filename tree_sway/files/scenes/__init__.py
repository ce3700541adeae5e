# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Scenes as files.

A YAML list of trees, a forester's table, or a YAML file that names one.
"""
