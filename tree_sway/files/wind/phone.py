# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Acceleration of a phone on a tree, read from its app phyphox over the network.

Where "remote access" is allowed in the app, ``GET /get?acc_time=full&accX=full`` answers with JSON
that has the numbers of a quantity under ``buffer``, its name, ``buffer`` (phyphox wiki,
"Remote-interface communication"). Both of its experiments with accelerations use these names.
"""

from __future__ import annotations

from http.client import HTTPException
import json
from urllib.request import urlopen

from tree_sway.errors import FormatError, TransportError
from tree_sway.files.wind.sway_table import parse_sway, SwayRecord

_QUANTITIES = 'acc_time accX accY accZ'.split()
_TIMEOUT = 5.0
_LARGEST = 2**26


def read_phone_sway(address: str) -> SwayRecord:
    """
    Read the measurement of a phone until now.

    Parameters
    ----------
    address
        Address as in phyphox, such as ``http://192.168.0.42:8080``.

    Raises
    ------
    TransportError
        No phone answers there.
    FormatError
        The answer has no accelerations, or an error of `parse_sway`.

    """
    asked = '&'.join(f'{name}=full' for name in _QUANTITIES)
    try:
        with urlopen(f'{address.rstrip("/")}/get?{asked}', timeout=_TIMEOUT) as answer:
            buffers = json.loads(answer.read(_LARGEST))['buffer']
        columns = [list(buffers[name]['buffer']) for name in _QUANTITIES]
    except (OSError, HTTPException) as error:
        raise TransportError(
            f'no phone answers ({error})',
            where=address,
            cure='allow remote access in phyphox, on the same network as this machine',
        ) from None
    except (ValueError, LookupError, TypeError):
        raise FormatError(
            'no accelerations in the answer',
            where=address,
            cure="open phyphox's experiment Acceleration (without g)",
        ) from None
    if not columns[0]:
        raise FormatError(
            'nothing is measured yet', where=address, cure='start the experiment in phyphox'
        )
    rows = [','.join(map(str, row)) for row in zip(*columns, strict=False)]
    return parse_sway(['time,ax,ay,az', *rows], address)
