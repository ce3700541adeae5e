# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Kinds of sources, one file each: options of its address, its transport and its reader.

Each has a function `open_source` and its row in ``sources.csv``, by which the registry finds it.
"""
