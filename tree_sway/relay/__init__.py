# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
One tree at several sites: the wind goes over the line, and each site solves.

`tree_site` steps a tree along samples of wind, `line` is the session of Zenoh between sites.
"""
