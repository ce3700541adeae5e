# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Trees to files: YAML, OBJ, glTF.

One function per format.
Pictures are made in ``view``.
"""
