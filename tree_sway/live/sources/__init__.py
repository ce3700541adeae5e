# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Kinds of sources, one file each: options of its address, its transport and its reader.

Each module has one `SourceKind` or more as ``SOURCES``, which the registry finds.
"""
