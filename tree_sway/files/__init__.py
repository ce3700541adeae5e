# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Files to trees and winds, and back.

Text, tables and schemas that several formats share live in this folder itself.
No ROS, no arithmetic of motion.
"""
