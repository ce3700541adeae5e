# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Diagnostics of solver and wind node.

Counts are from the library, levels are decided here. The hot path does not log.
"""
