# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
ROS 2 nodes that make a tree sway in measured wind, around the library `tree_sway`.

A node converts messages, calls the library and publishes. Nothing in `tree_sway` imports this
package.
"""
