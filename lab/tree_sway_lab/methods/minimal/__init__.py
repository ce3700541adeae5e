# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Methods on angles: one step per file.

The constraint is eliminated.
Shared mechanics in ``minimal_form``.

"""
