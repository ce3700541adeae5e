# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""How far motion sensors bring a model to a tree that it does not know."""
