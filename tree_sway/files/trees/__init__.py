# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Tree files: opened ones, their readers, segments to a `Tree`.

Formats by kind in the rooms below. This room computes no frequencies.
"""
