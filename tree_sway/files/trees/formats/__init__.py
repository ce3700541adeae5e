# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Formats of tree files: one file per kind, with its sniffer and its reader.

Each module has one `FileFormat` or more, which the registry finds. Code that formats share is in
the room above.
"""
