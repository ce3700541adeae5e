# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
From branches to matrices: inertia, stiffness, weight, natural modes.

This is done once per tree, before the first step. Nothing here runs in a step.
"""
