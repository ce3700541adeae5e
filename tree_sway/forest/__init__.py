# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Many trees in many winds with many settings, offline: ``tree-sway study STUDY.yaml``.

A plan becomes cases; each case is computed independently, in any process and order, once. Live
programs do not import this room.

"""
