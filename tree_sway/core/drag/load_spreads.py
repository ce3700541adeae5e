# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""How much the load by wind differs between trees that look alike; sources: `strength_band`."""

SHARE_WITHIN = 0.8
"""Share of trees within a band [-]."""

DRAG, LEAVES, WIND = 0.25, 0.35, 0.3
"""Log-deviations of the load by drag coefficient, leaf area and wind at the crown [-]."""
