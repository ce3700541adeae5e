# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Arguments of commands that serve the page."""

from __future__ import annotations

import argparse
import socket

from tree_sway.core.checks import within
from tree_sway.page.server import PageSettings

_PORT = 8765


def add_page_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the page's server."""
    add = parser.add_argument
    add('--open', action='store_true', help='open the page in the browser')
    add('--port', type=int, help=f'of the page ({_PORT}, or a free one if that is taken)')
    add(
        '--address',
        default='127.0.0.1',
        help="to bind to; any other than this machine's own needs a token (%(default)s)",
    )
    add(
        '--token-file',
        default='',
        metavar='FILE',
        help='token of viewers: a file that only its owner may read',
    )
    add('--certificate', default='', metavar='PEM', help='for https')
    add(
        '--origin',
        action='append',
        default=[],
        metavar='URL',
        help='of other pages that may follow the stream, as http://127.0.0.1:8000',
    )
    add('--private-key', default='', metavar='PEM', help='of the certificate')


def page_settings(arguments: argparse.Namespace) -> PageSettings:
    """Make settings of the page's server from the arguments; a `ParameterError` for a bad port."""
    port = arguments.port
    if port is None:
        port = _PORT if _is_free(arguments.address, _PORT) else 0
    within('--port', port, 0, 65535)
    return PageSettings(
        arguments.address,
        port,
        token_file=arguments.token_file,
        certificate=arguments.certificate,
        private_key=arguments.private_key,
        origins=tuple(arguments.origin),
    )


def _is_free(address: str, port: int) -> bool:
    family = socket.AF_INET6 if ':' in address else socket.AF_INET
    with socket.socket(family, socket.SOCK_STREAM) as trial:
        trial.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            trial.bind((address, port))
        except OSError:
            return False
    return True
