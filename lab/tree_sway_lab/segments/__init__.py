# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Every segment solved in 3D: the truth that reduced models are measured against.

Nothing here is reduced.

"""
