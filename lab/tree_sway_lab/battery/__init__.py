# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The cases where methods of integration fail, and what ours does there.

One row per file in ``rows``.
The methods live in ``study/methods``.

"""
