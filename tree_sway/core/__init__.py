# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The numeric core: trees, wind, reduced equations, poses.

Arrays in, arrays out; numpy, scipy and the native core. No ROS, no files, no clock, no
logging, no randomness without an ``rng`` argument.
"""
