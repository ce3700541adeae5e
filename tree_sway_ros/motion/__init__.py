# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Motion sensors of the solver: an annex, which the node finds by its entry point.

Without this folder the solver has no parameters `imu`, `camera`, `learn` and
`history`, and sways by the wind alone.
"""
