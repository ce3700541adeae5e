# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Set-up: all that is computed once per tree, before the first step.

Beams become matrices (`matrices`), matrices become modes (`modes`), modes and static deflections
become the coordinates (`gust_responses`, `static_responses`), and the wind load on these becomes a
table (`load_table`). Nothing here runs in a step.
"""
