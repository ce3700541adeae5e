# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Methods on the paper's coordinates with Lagrange multipliers: one step per file.

The constraint is enforced, stabilised or projected.
Shared mechanics in ``multiplier_form``.

"""
