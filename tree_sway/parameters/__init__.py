# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Parameters with default, unit, range and source.

One table each, which nodes, commands and the documentation read.
"""
