# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Output of commands without control characters, by which a file could steer the terminal.

Names of trees, columns and stations come from files and from the network. A control character
among them could clear the screen, forge a line or change its direction.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, ExitStack, redirect_stderr, redirect_stdout
import io
import sys

#: The controls of ISO/IEC 6429 except tab and newline, separators of lines and paragraphs, and
#: the controls of direction of the Unicode standard, annex 9.
_CONTROLS = (
    *range(0x00, 0x09), *range(0x0B, 0x20), *range(0x7F, 0xA0),
    *range(0x2028, 0x202F), *range(0x2066, 0x206A),
)  # fmt: skip
_ESCAPES = {code: ascii(chr(code))[1:-1] for code in _CONTROLS}


class _EscapedText(io.TextIOWrapper):
    """A text stream that writes control characters, and those that it lacks, as escapes."""

    def write(self, text: str) -> int:
        """Write a text, and return its length."""
        super().write(text.translate(_ESCAPES))
        return len(text)


@contextmanager
def escaped_output() -> Iterator[None]:
    """Escape all that is printed inside; streams without a buffer of bytes stay as they are."""
    with ExitStack() as stack:
        for stream, redirect in (
            (sys.stdout, redirect_stdout),
            (sys.stderr, redirect_stderr),
        ):
            if isinstance(stream, io.TextIOWrapper):
                stack.enter_context(redirect(stack.enter_context(_escaped(stream))))
        yield


@contextmanager
def _escaped(stream: io.TextIOWrapper) -> Iterator[_EscapedText]:
    stream.flush()
    escaped = _EscapedText(
        stream.buffer,
        encoding=stream.encoding,
        errors='backslashreplace',
        line_buffering=stream.line_buffering,
        write_through=stream.write_through,
    )
    try:
        yield escaped
    finally:
        escaped.detach()
