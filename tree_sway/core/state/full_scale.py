# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The whole numbers that a coordinate is sent as; who only reads them loads no kernel."""

FULL_SCALE = 32767
"""Greatest int16 that a coordinate is sent as."""

MARGIN = 5.0
"""
Full scale of a coordinate over its greatest value in the runs that a basis was made from: beyond
that the error of the basis is not known.

"""
