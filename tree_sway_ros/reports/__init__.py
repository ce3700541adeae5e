# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Diagnostics: what solver and wind node say of themselves.

Counts come from below, levels are decided here.
Nothing is logged from the hot path.
"""
