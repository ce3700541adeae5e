# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Methods of time integration side by side, in the multiplier form and in the minimal form.

Each declares its order, limit and source.

"""
