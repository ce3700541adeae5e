# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The wind from a sensor to the trees, by convention, gate, mean over a step, profile, travel.

Units, sign and limits of all samples are checked here. This room has no trees or messages.
"""
