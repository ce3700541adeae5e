# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The laboratory: methods side by side, battery, benches, charts, comparisons.

Reached by ``tree-sway lab battery|bench|chart|compare|paper|soak``. Nothing that runs imports it.

"""
