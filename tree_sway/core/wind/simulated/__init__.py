# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Winds that no sensor measured: turbulence of a given spectrum, gust events, a simulated anemometer.

Randomness comes from an ``rng`` argument.
What a recorded wind needs lives one room up.
"""
