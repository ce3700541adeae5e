# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Arrays to messages and back, parameters, timing, reports.

What nodes share, in one room per concern.
Nothing here solves anything.
"""
