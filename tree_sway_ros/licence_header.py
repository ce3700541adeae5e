# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Licence header of files of this package, for ``ament_copyright``.

It is found by the entry point ``ament_copyright.license`` of setup.py.
"""

from __future__ import annotations

from types import SimpleNamespace

APACHE_BY_SPDX = SimpleNamespace(
    name='Apache License, Version 2.0, by its SPDX name', spdx='Apache-2.0', license_files=(),
    file_headers=('{copyright}\nSPDX-License-Identifier: Apache-2.0',), contributing_files=(),
)  # fmt: skip
