# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Trees, forests and species written by people, as YAML with schemas.

Each schema is beside its reader. Other formats have their own rooms.
"""
