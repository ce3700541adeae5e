# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Access to the server: the token, the Origin of a page, the Host in the request of a browser.

A server on this machine's own address needs no token, but a page of a different site must not
reach it through the visitor's browser: its Origin, or its Host after a change of DNS, shows that.
The token is read from a file, as command lines and parameters can be read by other users of the
machine.

Who has the token may change the wind and the tree. The viewer's token is derived from it, by a
function that cannot be inverted: links with it can be passed on, to those who may only look.
"""

from __future__ import annotations

import base64
from collections import OrderedDict
from collections.abc import Mapping, Sequence
from enum import Enum
import hmac
from http.cookies import CookieError, SimpleCookie
import ipaddress
import os
from pathlib import Path
import secrets
import stat
from urllib.parse import urlsplit

from tree_sway.doorkeeper import is_loopback
from tree_sway.errors import ParameterError

_LARGEST_TOKEN = 256
_SHORTEST_TOKEN = 8
_OF_VIEWERS = b'tree_sway: may look'
_OF_COOKIES = b'tree_sway: cookie of who has control'
_DERIVED_SIZE = 24

WRONG_TOKEN = 'the token is missing or wrong'

GUESSES = 20
"""Number of wrong tokens from an address before it has to wait."""

GUESSING_TIME = 1.0
"""Time per wrong token of an address after that [s]."""

_MOST_ADDRESSES = 1024


class Access(Enum):
    """Access of a request: none, to look, or to change wind and tree too."""

    NONE = 0
    LOOK = 1
    CONTROL = 2


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


def make_token(path: str | Path) -> str:
    """
    Write a new token to a file that only its owner may read, and return it.

    Raises
    ------
    ParameterError
        A file that exists, or that cannot be written.

    """
    token = secrets.token_urlsafe()
    try:
        descriptor = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
        with open(descriptor, 'w', encoding='ascii') as file:
            file.write(f'{token}\n')
    except OSError as error:
        what = f'no token can be written ({error.strerror})'
        cure = 'name a new file in a folder that you may write to'
        raise ParameterError(what, where=str(path), cure=cure) from None
    return token


def viewers_token(token: str) -> str:
    """Token of those who may only look; empty where there is no token."""
    return _derived(token, _OF_VIEWERS)


def cookie_token(token: str) -> str:
    """Token in the cookie of a browser with control, so that the token itself is not stored."""
    return _derived(token, _OF_COOKIES)


def _derived(token: str, purpose: bytes) -> str:
    if not token:
        return ''
    digest = hmac.digest(token.encode(errors='surrogateescape'), purpose, 'sha256')
    return base64.urlsafe_b64encode(digest)[:_DERIVED_SIZE].decode()


def access_of(given: str, token: str) -> Access:
    """Return the access that a given token opens; without a token everybody has control."""
    if not token or _is_token(given, token) or _is_token(given, cookie_token(token)):
        return Access.CONTROL
    return Access.LOOK if _is_token(given, viewers_token(token)) else Access.NONE


class Guesses:
    """
    Wrong tokens by address: after `GUESSES` of them, one per `GUESSING_TIME` is read.

    The same wrong token again, as that of an old cookie, is no new guess. Of IPv6 the first 64
    bits are an address, as one visitor has all the others. The oldest of more than a thousand
    addresses are forgotten.
    """

    def __init__(self) -> None:
        # Time at which no guess of an address counts any longer, and its last guess.
        self._of: OrderedDict[str, tuple[float, int]] = OrderedDict()

    def waiting_time(self, address: str, now: float) -> float:
        """Time until a token of an address is read [s]; 0 if it is now."""
        full = (GUESSES - 1) * GUESSING_TIME
        clear_at, _ = self._of.get(_network(address), (0.0, 0))
        return max(0.0, clear_at - full - now)

    def note(self, address: str, given: str, now: float) -> None:
        """Count a wrong token."""
        network = _network(address)
        guess = hash(given)
        clear_at, last = self._of.pop(network, (0.0, None))
        if guess != last:
            clear_at = max(clear_at, now) + GUESSING_TIME
        self._of[network] = clear_at, guess
        if len(self._of) > _MOST_ADDRESSES:
            self._of.popitem(last=False)


def _network(address: str) -> str:
    try:
        version = ipaddress.ip_address(address.partition('%')[0])
    except ValueError:
        return address
    if isinstance(version, ipaddress.IPv6Address) and version.ipv4_mapped is None:
        return str(ipaddress.ip_network((version, 64), strict=False))
    return str(version)


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
        cure = 'give a token file (--token-file FILE makes one), or keep the address 127.0.0.1'
        raise ParameterError(what, where='page', cure=cure)


def given_token(headers: Mapping[str, str], query: Mapping[str, str], cookie: str = '') -> str:
    """Token of a request, in its header, its address or a cookie of that name; may be empty."""
    kind, _, token = headers.get('Authorization', '').partition(' ')
    if kind.lower() == 'bearer':
        return token.strip()
    return query.get('token') or _cookie(headers.get('Cookie', ''), cookie)


def _cookie(header: str, name: str) -> str:
    try:
        found = SimpleCookie(header).get(name)
    except CookieError:
        return ''
    return '' if found is None else found.value


def is_own_page(headers: Mapping[str, str]) -> bool:
    """
    Whether a request is that of the server's own page, or of a program.

    Pages of other origins can make a browser request a file, as by an image, but not send this
    header, nor an Origin that is not theirs.
    """
    return 'X-Requested-With' in headers or 'Origin' in headers


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
    host = headers.get('Host', '')
    origin = headers.get('Origin')
    if not f'{host}{origin}'.isascii():
        raise ValueError('an address with characters that addresses do not have')
    if is_loopback(address) and not is_loopback(_name_of(host)):
        return f"host '{host}' is not this machine"
    if origin is not None and origin not in origins and urlsplit(origin).netloc != host:
        return f"origin '{origin}' is not this server; start it with --origin {origin}"
    if access_of(given, token) is Access.NONE:
        return WRONG_TOKEN
    return None


def _is_token(given: str, token: str) -> bool:
    """Whether a token is right, compared in constant time."""
    return hmac.compare_digest(*(each.encode(errors='surrogateescape') for each in (given, token)))


def _name_of(host: str) -> str:
    """Return a Host header without its port."""
    if host.startswith('['):
        return host.partition(']')[0].lstrip('[')
    return host.rpartition(':')[0] or host
