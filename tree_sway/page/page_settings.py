# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Settings of the page's server: its address, and who may see and change the scene."""

from __future__ import annotations

from dataclasses import dataclass, field
import ssl

from tree_sway.errors import TransportError
from tree_sway.page.access import read_token, require_token

USUAL_PORT = 8765


@dataclass(frozen=True)
class PageSettings:
    """
    Address of the page and its access.

    Parameters
    ----------
    address, port
        Address to bind to; port 0 is a free one, None the usual one or, if it is in use, a free
        one.
    token, token_file
        Token of clients, or a file with it; needed for any address except this machine's own.
    certificate, private_key
        PEM files for TLS; none if empty.
    max_clients
        Largest number of pages.
    origins
        Other origins, as ``https://example.org``, whose pages may follow the stream.

    """

    address: str = '127.0.0.1'
    port: int | None = USUAL_PORT
    token: str = field(default='', repr=False)
    token_file: str = ''
    certificate: str = ''
    private_key: str = ''
    max_clients: int = 64
    origins: tuple[str, ...] = ()

    def url(self, port: int) -> str:
        """Return the address for a browser, without the token, of a server bound to a port."""
        scheme = 'https' if self.certificate else 'http'
        host = f'[{self.address}]' if ':' in self.address else self.address
        return f'{scheme}://{host}:{port}/'

    def required_token(self) -> str:
        """
        Return the token, of its file if it is there; empty where none is needed.

        Errors are those of `read_token` and `require_token`.
        """
        token = self.token or read_token(self.token_file)
        require_token(self.address, token)
        return token

    def tls(self) -> ssl.SSLContext | None:
        """
        Return the context of encrypted connections; None without a certificate.

        Raises
        ------
        TransportError
            Files that cannot be read, or are no certificate and key.

        """
        if not self.certificate:
            return None
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
        try:
            context.load_cert_chain(self.certificate, self.private_key or None)
        except OSError as error:
            raise TransportError(
                f'no certificate with its private key ({error.strerror or error})',
                where=' and '.join(filter(None, (self.certificate, self.private_key))),
                cure='give two PEM files, as doc/share_a_page.md makes them',
            ) from None
        return context
