# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Refused requests and messages of the page: every one is counted, some are logged."""

from __future__ import annotations

import logging
import time

_LOGGER = logging.getLogger('tree_sway.page')

_LOG_PERIOD = 10.0
"""Least time between two lines in the log [s]: an attacker must not fill the disk."""

_LONGEST = 200


class Refusals:
    """Counter of refusals, which logs one in `_LOG_PERIOD`."""

    def __init__(self) -> None:
        self.count = 0
        self._logged = -_LOG_PERIOD

    def note(self, what: str) -> None:
        """Count a refusal, and log it unless another was logged a moment ago."""
        self.count += 1
        now = time.monotonic()
        if now - self._logged >= _LOG_PERIOD:
            self._logged = now
            _LOGGER.warning('%s (%d refused since the start)', what[:_LONGEST], self.count)

    def note_record(self, record: logging.LogRecord) -> bool:
        """Note an error of the HTTP server in one line; False, as its traceback is not logged."""
        error = record.exc_info[1] if record.exc_info else None
        self.note(f'{record.getMessage()}: {error!a}')
        return False
