# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Readers of the messages of instruments: lines, JSON, forms; one file per format."""
