# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Sections of the validation, one subject per file.

Each has one function ``measure`` that returns a `Section`.

"""
