# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Skeletons of nodes: MTG, SWC, RayCloudTools.

Readers give nodes with a parent and a diameter.
Cylinder models live next door.

"""
