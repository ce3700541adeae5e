# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Kinds of sources, one file each: how its address is read, its transport, what its messages mean.

Each module has one `SourceKind` or more as ``SOURCES``, which the registry finds.
"""
