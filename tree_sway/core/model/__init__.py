# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The model as data, between set-up and run.

Settings, layouts of arrays, the laws that both use, states.
"""
