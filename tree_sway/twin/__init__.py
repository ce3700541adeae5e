# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
State estimation: motion sensors on the real tree correct the virtual one.

A steady-state Kalman filter corrects the motion that the wind alone would cause by what sensors on
the tree measure.
"""
