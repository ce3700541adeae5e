# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Address of a source as text: its scheme, its place and options, ``mqtt://host/topic?name=x``."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
import math
from pathlib import Path
import re
from typing import TypeVar
from urllib.parse import parse_qsl, SplitResult, unquote, urlsplit

from tree_sway.errors import FormatError, nearest, ParameterError, shown
from tree_sway.files import finite

T = TypeVar('T')

_LONGEST_NAME = 120
_SCHEME = re.compile(r'([a-z][a-z0-9-]*)(?=[:?#]|$)')


@dataclass
class SourceAddress:
    """
    Parts of an address; options are taken by name, and those left over are refused.

    Parameters
    ----------
    text
        The whole address.
    scheme
        Kind of source, such as ``mqtt``.
    parts
        The address as a URL.
    options
        Values by name, from the query and the fragment.

    """

    text: str
    scheme: str
    parts: SplitResult
    options: dict[str, str]
    known: set[str] = field(default_factory=set)

    @property
    def place(self) -> str:
        """Text after the scheme of an address without ``//``."""
        return unquote(self.parts.path)

    @property
    def name(self) -> str:
        """Name for viewers and for columns of tables, on one line; empty without one."""
        return shown(self.text_of('name'), _LONGEST_NAME)

    @property
    def host(self) -> str:
        """Host, maybe empty."""
        return self.parts.hostname or ''

    def port(self, default: int = 0, cure: str = '') -> int:
        """Port, which may be all of the place; a `ParameterError` without one or a default."""
        is_port = not self.parts.netloc and self.place.isdecimal()
        try:
            port = int(self.place) if is_port else self.parts.port
        except ValueError:
            port = 0
        port = default if port is None else port
        if not 0 < port < 65_536:
            raise self.error('a port from 1 to 65535 is missing', cure)
        return port

    def text_of(self, name: str, default: str = '') -> str:
        """Return an option."""
        self.known.add(name)
        return self.options.get(name, default)

    def number(
        self, name: str, default: float, low: float = -math.inf, high: float = math.inf
    ) -> float:
        """Return an option as a number within a range."""
        text = self.text_of(name)
        if not text:
            return default
        value = finite(text)
        if value is None or not low <= value <= high:
            raise self.error(f"{name} is '{text}', not a number from {low:g} to {high:g}")
        return value

    def whole(self, name: str, default: int, low: int, high: int) -> int:
        """Return an option as a whole number within a range; hexadecimal with ``0x``."""
        text = self.text_of(name)
        try:
            value = int(text, 0) if text else default
        except ValueError:
            value = low - 1
        if not low <= value <= high:
            raise self.error(f"{name} is '{text}', not a whole number from {low} to {high}")
        return value

    def silence(self, default: float = 10.0) -> float:
        """Return the option ``silence``: without a message for so long, it is opened again [s]."""
        return self.number('silence', default, 0.1, 86_400.0)

    def angle(self, name: str, default: float = 0.0) -> float:
        """Return an option in degrees, of a name that ends so, as [rad]."""
        return math.radians(self.number(name, math.degrees(default), -360.0, 360.0))

    def secret(self, name: str) -> str:
        """Return the first line of the file that an option names; empty without it."""
        path = self.text_of(name)
        if not path:
            return ''
        try:
            return Path(path).expanduser().read_text('utf-8').split('\n')[0].strip()
        except (OSError, ValueError) as error:
            reason = getattr(error, 'strerror', None) or 'it is no text'
            raise FormatError(f'not readable: {reason}', where=f'{name}={path}') from None

    def headers(self) -> dict[str, str]:
        """Return the header with the token in the file ``token_file``; none without that."""
        token = self.secret('token_file')
        return {'Authorization': f'Bearer {token}'} if token else {}

    def refuse_others(self) -> None:
        """Raise a `ParameterError` for an option that the source does not have."""
        for name in self.options:
            if name not in self.known:
                cure = nearest(name, self.known) or f'it has {", ".join(sorted(self.known))}'
                raise self.error(f"no option '{name}'", cure)

    def kind_of(self, kinds: Mapping[str, T], what: str, where: str, forms: str) -> T:
        """Return the kind of its scheme; a `ParameterError` for one that is not there."""
        if self.scheme not in kinds:
            cures = nearest(self.scheme, kinds), f'give one of {forms}'
            raise ParameterError(
                f"'{self.text}' is no {what}", where=where, cure='; '.join(filter(None, cures))
            )
        return kinds[self.scheme]

    def error(self, what: str, cure: str = '') -> ParameterError:
        """Make an error of this address."""
        return ParameterError(what, where=self.text, cure=cure)


def _meant(text: str) -> str:
    """Return the address that is probably meant by one without a kind."""
    if text.isascii() and text.isdigit():
        return f'udp:{text}'
    if text.startswith('/dev/') or re.fullmatch(r'COM\d+', text):
        return f'serial:{text}'
    if re.fullmatch(r'[\w.-]+:\d+', text):
        return f'tcp://{text}, or http://{text}/'
    return 'one such as udp:5006, http://host:port/ or serial:/dev/ttyUSB0'


def read_source_address(text: str, where: str = 'sensor', cure: str = '') -> SourceAddress:
    """
    Read an address.

    Options are in the query, or in the fragment if there is one: then the whole query belongs to
    the server of the address. Raises a `ParameterError` for text without a scheme.
    """
    scheme = _SCHEME.match(text)
    name, mark, query = text.partition('?')
    try:
        parts = urlsplit(text if ':' in name else f'{name}:{mark}{query}')
    except ValueError as error:
        raise ParameterError(f'not an address ({error})', where=text) from None
    if scheme is None:
        raise ParameterError(
            f"'{text}' does not begin with a kind of source",
            where=where,
            cure=cure or f'give {_meant(text)}',
        )
    options = dict(parse_qsl(parts.fragment or parts.query, keep_blank_values=True))
    return SourceAddress(text, scheme[1], parts, options)
