# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Text of a file, or an error with the reason.

Every importer reads through these functions, so that a missing file, a folder, a binary file or a
huge one gives the same short error for each format.
"""

from __future__ import annotations

from codecs import getincrementaldecoder
from contextlib import suppress
import math
from pathlib import Path
import re

from tree_sway.errors import FormatError
from tree_sway.files.foreign_file import foreign_file

MAX_BYTES = 256 * 1024 * 1024
"""Largest size of a file, so that no input fills the memory [bytes]."""
MAX_LINES = 4_000_000
"""Largest number of lines of a file: two days at 20 Hz are 3.5 million."""

# Each digit matches in one way only, so that the time is proportional to the length.
_NUMBER = re.compile(r'[-+]?(\d+(\.\d*)?|\.\d+)([eE][-+]?\d+)?', re.ASCII)
_PAGES = {
    'cp932': rb'\x82[\x9f-\xf1]|\x83[\x40-\x96]|[\x88-\x97].',
    'cp949': rb'[\xb0-\xc8][\xa1-\xfe]',
    'big5': rb'[\xa4-\xc6].',
    'gb18030': rb'[\xb0-\xd7][\xa1-\xfe]',
}
"""
Pages of two bytes a letter, and the bytes of their usual letters.

These are kana and the kanji of the first level, Hangul, and the ideographs of the first level.
Text of another page has few of them, and in code page 1252 they are rows of signs.
"""
_CENTRAL = re.compile(r'[a-z][³¹¿][a-z]|\A(?!.*[æå])(?=.*ø).*[ìšžïý]', re.DOTALL)
"""Letters of Poland and Czechia, of code page 1250, as 1252 has them; Nordic ones beside ø."""
_USUAL = 0.9
"""Share of the letters of a text that are usual ones in its page."""
_AS_MANY = 0.05
"""Difference of the shares of two pages of which the first is taken."""
_SAMPLE = 1 << 14
_MARKS = {'utf-32': (b'\xff\xfe\0\0', b'\0\0\xfe\xff'), 'utf-16': (b'\xff\xfe', b'\xfe\xff')}
"""Byte order marks; that of UTF-32 begins as that of UTF-16."""
_DECIMAL_COMMA = re.compile(r'[-+]?\d*,\d+([eE][-+]?\d+)?', re.ASCII)


def read_bytes(path: Path, at_most: int = -1) -> bytes:
    """
    Read a file, or a number of bytes from its beginning.

    Raises a `FormatError` if it is missing, not a file, not readable or larger than `MAX_BYTES`.
    """
    try:
        is_there = path.exists()
    except (OSError, ValueError):  # a name that is too long, or has a zero byte
        is_there = False
    if not is_there:
        raise FormatError('no such file', where=str(path), cure='check the path')
    if not path.is_file():
        raise FormatError('not a file', where=str(path), cure='name a file')
    if at_most < 0 and path.stat().st_size > MAX_BYTES:
        raise FormatError(
            f'larger than {MAX_BYTES >> 20} MiB', where=str(path), cure='cut it into smaller files'
        )
    try:
        with path.open('rb') as stream:
            return stream.read(at_most)
    except OSError as error:
        raise FormatError(f'cannot be read: {error.strerror}', where=str(path)) from error


def read_head(path: Path) -> str:
    """
    Read the beginning of a file, enough for its format.

    Other bytes than text are replaced in a file that has zero bytes, and so is not text.
    """
    return decoded(read_bytes(path, at_most=4096), 'replace')


def decoded(data: bytes, errors: str = 'strict') -> str:
    """
    Return bytes as text: UTF-16 or UTF-32, UTF-8, else a code page of Windows.

    That is the one of `_PAGES` in which most letters, and nearly all, are usual ones, the first of
    several, else 1250 or 1252; a spreadsheet writes CSV in these.
    ``errors`` is for bytes that are none of them.
    """
    for encoding, marks in _MARKS.items():
        if data.startswith(marks):
            return data.decode(encoding, errors)
    # ASCII in UTF-16 has a zero byte beside each letter.
    odd = data[1:200:2]
    even = data[:200:2]
    for zeros, ascii_bytes, encoding in ((odd, even, 'utf-16-le'), (even, odd, 'utf-16-be')):
        if zeros and not any(zeros) and all(ascii_bytes):
            return data.decode(encoding, errors)
    try:
        return data.decode('utf-8-sig')
    except UnicodeDecodeError as error:
        is_cut = errors == 'replace' and error.start > len(data) - 4
        if is_cut or b'\0' in data:
            return data.removeprefix(b'\xef\xbb\xbf').decode('utf-8', errors)
        begin = data.rfind(b'\n', 0, error.start) + 1
    shares = dict.fromkeys(_PAGES, 0.0)
    for page, usual in _PAGES.items():
        with suppress(UnicodeDecodeError):
            shares[page] = _usual_share(data[begin : begin + _SAMPLE], page, usual)
    least = max(_USUAL, max(shares.values()) - _AS_MANY)
    for page in [page for page, share in shares.items() if share >= least][:1]:
        with suppress(UnicodeDecodeError):
            return data.decode(page, errors)
    western = data[begin : begin + _SAMPLE].decode('cp1252', 'replace')
    return data.decode('cp1250' if _CENTRAL.search(western) else 'cp1252', errors)


def _usual_share(data: bytes, page: str, usual: bytes) -> float:
    """Share of usual ones of a page in letters beyond ASCII; 0 where none are side by side."""
    text = getincrementaldecoder(page)().decode(data)  # a letter may be cut at the end
    is_usual = re.compile(usual, re.DOTALL).fullmatch
    runs = re.findall(r'[^\W\d_\x00-\x7f]+', text)
    letters = ''.join(runs)
    count = sum(is_usual(letter.encode(page)) is not None for letter in letters)
    return count / len(letters) if max(map(len, runs), default=0) > 1 else 0.0


def read_text(path: Path) -> str:
    """Read a text file in UTF-8, with or without a byte order mark; else a `FormatError`."""
    try:
        return read_bytes(path).decode('utf-8-sig')
    except UnicodeDecodeError as error:
        raise _no_text(error, path) from None


def _no_text(error: UnicodeDecodeError, path: Path) -> FormatError:
    """Make the error of a file that is not text."""
    begin = error.object[:99].decode('latin-1')
    kind, cure = max(foreign_file(path), foreign_file(path, begin))
    what = f'not UTF-8 text: byte {error.start} is {error.object[error.start]:#04x}'
    return FormatError(kind or what, where=str(path), cure=cure or 'save it as UTF-8')


def read_lines(path: Path) -> list[str]:
    """Read a file as lines, in any encoding of `decoded`; a `FormatError` for binary data."""
    try:
        return table_lines(decoded(read_bytes(path)), path)
    except UnicodeDecodeError as error:
        raise _no_text(error, path) from None


def table_lines(text: str, path: Path) -> list[str]:
    """Return the lines of a text; a `FormatError` above `MAX_LINES`."""
    if max(text.count('\n'), text.count('\r')) > MAX_LINES:
        raise FormatError(
            f'more than {MAX_LINES} lines', where=str(path), cure='cut it into smaller files'
        )
    return text.replace('\r\n', '\n').replace('\r', '\n').split('\n')


def finite(text: str) -> float | None:
    """Read a plain decimal number; None for other text, such as empty, NaN or infinite."""
    cell = text.strip()
    if _NUMBER.fullmatch(cell) is None:
        return None
    value = float(cell)
    return value if math.isfinite(value) else None


def reason_of(error: Exception) -> str:
    """Kind and text of an error of a library, on one line of at most 200 characters."""
    return f'{type(error).__name__}: {" ".join(str(error).split())}'[:200]


def why_no_number(text: str) -> str:
    """Describe why a cell is not a finite number, with the cell."""
    cell = text.strip()
    if _DECIMAL_COMMA.fullmatch(cell):
        return f"'{cell[:40]}', with a decimal comma: export it with decimal points"
    return f"'{cell[:40]}', not a finite number"
