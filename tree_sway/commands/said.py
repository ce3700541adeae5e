# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What a command says beside its result: notes, warnings and news, on standard error."""

from __future__ import annotations

import sys


def say(text: object, kind: str = 'note') -> None:
    """Print a line of a kind, in one write: threads of live sources print as well."""
    print(f'{kind}: {text}\n', end='', file=sys.stderr, flush=True)
