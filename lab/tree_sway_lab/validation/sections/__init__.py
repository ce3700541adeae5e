# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
What is measured, a subject per file.

Each has one function ``measure`` that returns a `Section`.

"""
