# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Records of motion sensors on real trees: tables and bags."""
