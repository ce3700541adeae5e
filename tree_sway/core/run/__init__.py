# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Run: what happens per frame. A tree is stepped, pushed, tuned and placed.

The simulator of one tree is `simulator`; scenes of many trees are in the room ``scene``.
"""
