# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Arguments of commands that serve the page."""

from __future__ import annotations

import argparse
from pathlib import Path
from urllib.parse import urlencode, urlsplit

from tree_sway.commands import say
from tree_sway.core.checks import within
from tree_sway.doorkeeper import is_loopback
from tree_sway.errors import ParameterError
from tree_sway.page import PageServer, PageSettings, read_token
from tree_sway.page.access import make_token
from tree_sway.page.page_settings import USUAL_PORT


def add_page_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the page's server."""
    add = parser.add_argument_group('page').add_argument
    add('--open', action='store_true', help='open the page in a browser')
    add('--port', type=int, help=f'TCP port of the web server ({USUAL_PORT}, or a free one)')
    add(
        '--address',
        default='127.0.0.1',
        help='address to listen on; any but this machine itself needs a token (%(default)s)',
    )
    add(
        '--token-file',
        default='',
        metavar='FILE',
        help='file with the access token, readable by its owner alone; created if missing',
    )
    add('--certificate', default='', metavar='PEM', help='TLS certificate (PEM), to serve https')
    add(
        '--origin',
        action='append',
        default=[],
        metavar='URL',
        help='another origin whose pages may connect, such as http://127.0.0.1:8000',
    )
    add('--private-key', default='', metavar='PEM', help='private key of the certificate (PEM)')


def page_settings(arguments: argparse.Namespace) -> PageSettings:
    """
    Make settings of the page's server from the arguments, and a missing file with a token.

    A `ParameterError` reports a bad port or origin, or a token that cannot be written.
    """
    if arguments.port is not None:
        within('--port', arguments.port, 0, 65535)
    for origin in arguments.origin:
        parts = urlsplit(origin if '//' in origin else f'http://{origin}')
        sent = f'{parts.scheme}://{parts.netloc}'
        if sent != origin:
            cure = f'browsers send a scheme and a host: --origin {sent}'
            raise ParameterError(f"--origin is '{origin}'", cure=cure)
    if arguments.token_file and not Path(arguments.token_file).exists():
        make_token(arguments.token_file)
        print(f'{arguments.token_file}: a new token, which only you may read', flush=True)
    return PageSettings(
        arguments.address,
        arguments.port,
        token_file=arguments.token_file,
        certificate=arguments.certificate,
        private_key=arguments.private_key,
        origins=tuple(arguments.origin),
    )


def print_address(server: PageServer, begin: str) -> None:
    """Print the address of the page; with a token, the links for control and for viewers."""
    if not server.viewers_token:
        print(f'{begin} {server.url}', flush=True)
        return
    if server.url.startswith('http:') and not is_loopback(server.settings.address):
        say(
            'without a certificate everybody on the way can read these links and what they show '
            '(doc/share_a_page.md)',
            'warning',
        )
    token = read_token(server.settings.token_file)
    print(f'{begin} {server.url}?{urlencode({"token": token})}')
    print(f'to look only: {server.url}?{urlencode({"token": server.viewers_token})}', flush=True)
