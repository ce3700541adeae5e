# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
rclpy entry points: one node class per file.

A node converts, calls and publishes, without arithmetic beyond units.
"""
