# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Watching a stream from outside: what arrives, its figures, its words.

Nothing here grows with the length of a stream.
"""
