# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A 3D beam frame of a tree: the independent check of frequencies and statics.

Euler-Bernoulli elements with weight and twist.
Nothing that runs uses it.

"""
