# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Access to the server: the token, the Origin of a page, the Host in the request of a browser.

A server on this machine's own address needs no token, but a page of a different site must not
reach it through the visitor's browser: its Origin, or its Host after a change of DNS, shows that.
The token is read from a file, as command lines and parameters can be read by other users of the
machine.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
import hmac
import ipaddress
from pathlib import Path
import stat
from urllib.parse import urlsplit

from tree_sway.errors import ParameterError

_OWN_NAMES = ('localhost',)
_LARGEST_TOKEN, _SHORTEST_TOKEN = 256, 8


def is_loopback(address: str) -> bool:
    """Whether an address to bind to is reachable only from this machine."""
    if address in _OWN_NAMES:
        return True
    try:
        return ipaddress.ip_address(address.strip('[]')).is_loopback
    except ValueError:
        return False


def read_token(path: str | Path) -> str:
    """
    Token on the first line of a file; empty for no path.

    Raises
    ------
    ParameterError
        No such file, one that every user of the machine may read, or no token in it.

    """
    if not path:
        return ''
    try:
        mode = Path(path).stat().st_mode
        with open(path, encoding='ascii') as file:
            text = file.read(_LARGEST_TOKEN + 1) if stat.S_ISREG(mode) else ''
    except (OSError, ValueError) as error:
        what = f'the token cannot be read ({type(error).__name__})'
        cure = 'give a text file with the token on its first line'
        raise ParameterError(what, where=str(path), cure=cure) from None
    if mode & stat.S_IRWXO:
        what = 'every user of this machine may read the token'
        raise ParameterError(what, where=str(path), cure=f'chmod o-rwx {path}')
    token = text.strip()
    if not _SHORTEST_TOKEN <= len(token) <= _LARGEST_TOKEN or not token.isprintable():
        what = f'no token of {_SHORTEST_TOKEN} to {_LARGEST_TOKEN} letters'
        cure = 'write one, as python3 -c "import secrets; print(secrets.token_urlsafe())" does'
        raise ParameterError(what, where=str(path), cure=cure)
    return token


def require_token(address: str, token: str) -> None:
    """
    Refuse to serve others without a token.

    Raises
    ------
    ParameterError
        An address other than this machine's own, without a token of at least 8 characters.

    """
    if not is_loopback(address) and len(token) < _SHORTEST_TOKEN:
        what = f'address {address} without a token of at least {_SHORTEST_TOKEN} characters'
        cure = 'give a token_file, or keep the address 127.0.0.1'
        raise ParameterError(what, where='page', cure=cure)


def given_token(headers: Mapping[str, str], query: Mapping[str, str]) -> str:
    """Token of a request, in its header or its address; may be empty."""
    kind, _, token = headers.get('Authorization', '').partition(' ')
    return token.strip() if kind.lower() == 'bearer' else query.get('token', '')


def refusal(
    headers: Mapping[str, str],
    given: str,
    *,
    address: str,
    token: str,
    origins: Sequence[str] = (),
) -> str | None:
    """
    Return why a request is refused; None if it is not.

    Parameters
    ----------
    headers
        Headers of the request.
    given
        Token of the request; may be empty.
    address, token
        Address of the server and its token.
    origins
        Other origins whose pages may follow the stream.

    Raises
    ------
    ValueError
        An Origin or a Host that is no address.

    """
    host, origin = headers.get('Host', ''), headers.get('Origin')
    if not f'{host}{origin}'.isascii():
        raise ValueError('an address with characters that addresses do not have')
    if is_loopback(address) and not is_loopback(_name_of(host)):
        return f"host '{host}' is not this machine"
    if origin is not None and origin not in origins and urlsplit(origin).netloc != host:
        return f"origin '{origin}' is not this server"
    if token and not is_token(given, token):
        return 'the token is missing or wrong'
    return None


def is_token(given: str, token: str) -> bool:
    """Whether a token is right, compared in constant time."""
    return hmac.compare_digest(*(each.encode(errors='surrogateescape') for each in (given, token)))


def _name_of(host: str) -> str:
    """Return a Host header without its port."""
    if host.startswith('['):
        return host.partition(']')[0].lstrip('[')
    return host.rpartition(':')[0] or host
