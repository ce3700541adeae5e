# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Our simulator against MuJoCo, in one run.

The same tree, wind and damping on both sides.
MuJoCo is an optional dependency.

"""
