# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Parameters of nodes: one table each, from which declaration, checks and documents come.

After a refusal the old value stays. The meaning of a parameter is in the module that uses it.
"""
