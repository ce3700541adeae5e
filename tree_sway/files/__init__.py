# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Files to trees and winds, and back.

Text, tables and schemas that several formats share are in this folder itself. It has no ROS and no
arithmetic of motion.
"""
