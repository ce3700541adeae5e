# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Tree files: what an opened one is, which reader takes which file, segments to a `Tree`.

Formats by kind in the rooms below.
Nothing here computes a frequency.
"""
