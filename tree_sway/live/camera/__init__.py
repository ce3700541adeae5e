# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Pictures of the real tree: films and live cameras by OpenCV, and points that are followed in them.

A page follows those of its own camera, and sends their places.
No picture is kept or sent: what leaves this room are times and places of points.
"""
