# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Formats of tree files: one file per kind, with its sniffer and its reader.

Each module here has a `FileFormat` or more; the registry finds them by itself.
What formats share does not live here.
"""
