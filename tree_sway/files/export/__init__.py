# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Trees to files: YAML, glTF, USD, MJCF, SDF.

One function per format.
"""
