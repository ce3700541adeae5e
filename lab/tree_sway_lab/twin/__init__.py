# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Trials of motion sensors: how well a model follows a tree of unknown wood, damping and gusts."""
