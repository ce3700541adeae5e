# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Received bytes, cut into lines; other data than lines of a sensor is dropped and counted."""

from __future__ import annotations

from collections.abc import Iterator

LONGEST = 16 * 1024
"""Largest length of a line [bytes]: a delta of Signal K has some thousand."""


class Lines:
    """Buffer of an incomplete line, of at most `LONGEST` bytes."""

    def __init__(self) -> None:
        self.dropped = 0
        self._begun = b''
        self._is_too_long = False

    def feed(self, data: bytes) -> Iterator[bytes]:
        """Add bytes; return the complete lines."""
        *whole, begun = (self._begun + data).replace(b'\r', b'\n').split(b'\n')
        for line in whole:
            if self._is_too_long or len(line) > LONGEST:
                self.dropped += 1
                self._is_too_long = False
            elif line:
                yield line
        if len(begun) > LONGEST:
            begun = b''
            self._is_too_long = True
        self._begun = begun
