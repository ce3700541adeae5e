# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Tables and drawings of the pages, taken from the code.

One command keeps them up to date.
Charts and portraits are made next door, in ``chart``.

"""
