# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Stands as a forester has them: a table of places, species and heights.

A table alone, or a YAML file that names one and says what stands for its species.
"""
