# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
No more model than a scene needs: error and cost of every model, and the choice among them.

Estimates are made before a step is taken.
The models themselves live lower.
"""
