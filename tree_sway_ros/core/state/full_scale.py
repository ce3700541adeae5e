# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The whole numbers that a coordinate is told by; who only reads them loads no kernel."""

FULL_SCALE = 32767
"""Greatest int16 that a coordinate is told by."""
