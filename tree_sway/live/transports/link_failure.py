# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Why a connection failed, with what to do about it: `link_failures.csv` has it by the error."""

from __future__ import annotations

import errno
import re
import socket
import ssl

from tree_sway.errors import shown
from tree_sway.tables import table_beside

_CURES = {
    getattr(errno, each['error']): each['cure']
    for each in table_beside(__file__, 'link_failures.csv')
}
_LONGEST = 240
_NUMBER = re.compile(r'(?:\[Errno |Error\()(\d+)')


def failure_text(error: Exception) -> str:
    """
    Return why a connection failed, on one line.

    Errors of the operating system are told by what to do, also inside those of a library. The text
    of another `ConnectionError` is kept, and other errors have their type before theirs.
    """
    certificate = getattr(error, 'certificate_error', error)  # of aiohttp
    if isinstance(certificate, ssl.SSLCertVerificationError):
        advice = 'if the site signed it itself, name it: SSL_CERT_FILE=there.pem'
        return shown(f'untrusted certificate ({certificate.verify_message}); {advice}', _LONGEST)
    inner = getattr(error, 'os_error', error)  # of aiohttp
    if isinstance(inner, socket.gaierror):
        return 'no such name: check it, and the network'
    if isinstance(inner, TimeoutError):
        return _CURES[errno.ETIMEDOUT]
    if cure := _CURES.get(_number(inner)):
        return cure
    if isinstance(error, ConnectionError) and str(error):
        return shown(str(error), _LONGEST)
    name = type(error).__name__
    return shown(f'{name}: {error}' if str(error) else name, _LONGEST)


def _number(error: BaseException) -> int:
    """Return the number of an error of the operating system; 0 for others."""
    if not isinstance(error, OSError):
        return 0
    if error.errno:
        return error.errno
    # pyserial on Windows, and asyncio for several addresses, have it in their text alone.
    found = _NUMBER.search(str(error))
    return int(found[1]) if found else 0
