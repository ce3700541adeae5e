# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The per-step path: load, oscillators, key rotations, placing of every segment.

Structure-of-arrays records and kernels; no allocation per step. The choice of the model is made in
rooms above.
"""
