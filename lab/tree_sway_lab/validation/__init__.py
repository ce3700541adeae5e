# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Checks of the models against truth, on trees that were not made for them.

Trees are random and crooked, winds measured and simulated, truth solves every segment.

"""
