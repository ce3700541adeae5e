# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Prepared models of trees on disk: in the cache, and as files of their own."""
