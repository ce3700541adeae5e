# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The experiment of Kanda & Ohya (J-11) as it is written, and what this package does in its place.

Key segments by multipliers and in the reduced form, planar followers, wind from the right.
Nothing that runs imports it.

"""
