# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Motion sensors on the real tree keep the virtual one true.

A steady-state Kalman filter corrects the motion that the wind alone would cause by what sensors on
the tree measure.
"""
