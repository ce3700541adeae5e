# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Pictures and films of trees with matplotlib.

Projection, bark, leaves, plots. Solving and streaming do not need this room.
"""
