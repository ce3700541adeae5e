# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The native core, ``native/`` of the source, as Python calls it: by ctypes, arrays checked."""
