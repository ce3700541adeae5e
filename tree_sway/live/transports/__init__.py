# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Ways in which messages of instruments arrive, one file each; readers interpret the bytes.

Each is a `Transport`; a `Link` runs it on a thread and connects again when it breaks.
"""
