# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Several trees in one wind: where they are, when a gust reaches them, how exact each must be.

`make` is the door to every kind of simulator.
Nothing here draws or publishes.
"""
