# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Rows T1 to T18 of the battery, the smallest case of each failure.

Each gives rows with a figure, a bound and whether it holds.
A known failure is reproduced, not left out.

"""
