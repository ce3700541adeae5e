# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Used share of the strength of a tree: of the wood by its strain, of the roots by the base moment.

Strain along every branch, shares and their bands. This is no verdict on safety.
"""
