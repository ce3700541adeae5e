# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What is stored on disk between runs: the set-ups of trees."""
