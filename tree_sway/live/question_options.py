# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Options of instruments that answer questions: ``ask``, ``every`` and ``silence``."""

from __future__ import annotations

from tree_sway.live.source_address import SourceAddress
from tree_sway.live.transports.stream_lines import Question

_SILENCE = 10.0
"""Time [s] without a message after which a connection is made again."""


def question_of(address: SourceAddress) -> Question:
    r"""
    Read the options ``ask``, sent every ``every`` [s], by default each second.

    A carriage return and a line feed are added, but to a command of SDI-12, which ends with ``!``.
    """
    text = address.text_of('ask')
    every = address.number('every', 1.0, 0.05, 3600.0)
    end = '' if not text or text.endswith('!') else '\r\n'
    return Question(f'{text}{end}'.encode(), every)


def silence_of(address: SourceAddress, default: float = _SILENCE) -> float:
    """Read the option ``silence`` [s]."""
    return address.number('silence', default, 0.1, 86_400.0)
