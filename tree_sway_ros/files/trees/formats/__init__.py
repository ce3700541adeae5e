# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Formats of tree files: one file per format, with its sniffer and its reader.

Each module here has a `TreeFormat` called ``FORMAT``; the registry finds it by itself.
What formats share does not live here.

"""
