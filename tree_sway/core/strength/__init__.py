# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
How much of its strength a tree uses: the wood by its strain, the roots by the moment at the foot.

Strain along every branch, shares and their bands.
There is no verdict here.
"""
