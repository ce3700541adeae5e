# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A motion sensor opened by its address."""

from __future__ import annotations

from dataclasses import replace

from tree_sway.live.motion.motion_json import EXPECTS, read_motion_json
from tree_sway.live.motion.phyphox import EXPECTS as OF_PHYPHOX
from tree_sway.live.motion.phyphox import PhyphoxPhone
from tree_sway.live.source import Source
from tree_sway.live.source_address import read_source_address, SourceAddress
from tree_sway.live.sources.lines import udp_of
from tree_sway.live.sources.mqtt_topic import broker_of

_FORMS = 'http://PHONE:8080 (phyphox), udp:PORT, mqtt://host/topic'
"""Addresses as examples."""


def open_motion(text: str) -> Source:
    """
    Open a motion sensor by its address.

    Parameters
    ----------
    text
        ``http://PHONE:8080`` for phyphox; ``udp:PORT`` and ``mqtt://host/topic`` for JSON. The
        option ``name`` is for viewers.

    Raises
    ------
    ParameterError
        An unknown kind of address, or an option that it does not have.
    MissingDependencyError
        A library that it needs is not installed.

    """
    address = read_source_address(text, '--motion', f'give one of {_FORMS}')
    known = {
        'http': _phyphox, 'https': _phyphox, 'udp': _udp, 'mqtt': _mqtt, 'mqtts': _mqtt,
    }  # fmt: skip
    source = address.kind_of(known, 'live motion sensor', '--motion', _FORMS)(address)
    name = address.name
    address.refuse_others()
    return replace(source, name=name or source.name)


def _phyphox(address: SourceAddress) -> Source:
    parts = address.parts
    if not address.host:
        raise address.error('no host', 'give http://PHONE:8080, which phyphox shows')
    if parts.path.strip('/'):
        raise address.error(f"a path '{parts.path}'", 'give what phyphox shows, http://PHONE:8080')
    url = f'{address.scheme}://{parts.netloc}'
    phone = PhyphoxPhone(url, address.number('every', 0.05, 0.02, 1.0))
    return Source(phone, phone.read, 'phyphox', OF_PHYPHOX, ticks=1.0)


def _udp(address: SourceAddress) -> Source:
    link = udp_of(address)
    return Source(link, read_motion_json, f'UDP {link.port}', EXPECTS)


def _mqtt(address: SourceAddress) -> Source:
    topic = address.place.removeprefix('/')
    return Source(broker_of(address, (topic,)), read_motion_json, topic, EXPECTS)
