# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The whole chain through every fault of a sensor, for hours, and what it costs.

Every node is a process of its own, as on a robot.
"""
