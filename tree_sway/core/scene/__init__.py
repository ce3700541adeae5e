# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Several trees in one wind: their places, delays of gusts, and accuracy.

`make` makes every kind of simulator. Nothing here draws or publishes.
"""
