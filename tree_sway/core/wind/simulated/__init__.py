# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Simulated winds: turbulence of a given spectrum, gust events, a simulated anemometer.

Randomness comes from an ``rng`` argument. Recorded winds are in the room above.
"""
