# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Licence header of files of this package, for `ament_copyright`.

It is found by the entry point ``ament_copyright.license`` of setup.py.
"""

from __future__ import annotations

from typing import NamedTuple


class LicenceHeader(NamedTuple):
    """A licence for `ament_copyright`: texts in files, and its SPDX name."""

    name: str
    spdx: str
    file_headers: tuple[str, ...]
    license_files: tuple[str, ...] = ()
    contributing_files: tuple[str, ...] = ()


APACHE_BY_SPDX = LicenceHeader(
    'Apache License, Version 2.0, by its SPDX name',
    'Apache-2.0',
    ('{copyright}\nSPDX-License-Identifier: Apache-2.0',),
)
