# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
One branch as a beam: bending, twist, the shapes it takes and the model made from them.

Closed forms and quadratures along one branch. Coupled branches are in ``setup``.
"""
