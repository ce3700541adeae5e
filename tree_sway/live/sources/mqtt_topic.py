# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A topic of an MQTT broker: Home Assistant, Zigbee, rtl_433, ChirpStack, The Things Network."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from urllib.parse import unquote

from tree_sway.files.wind import bearing_of, Readings, WindReading
from tree_sway.live.readers.instrument_lines import lines_of
from tree_sway.live.source import Source
from tree_sway.live.source_address import SourceAddress
from tree_sway.live.transports.mqtt import Mqtt, PORT, TLS_PORT
from tree_sway.live.transports.transport import Message

_Read = Callable[[Message], Readings]


def open_source(address: SourceAddress) -> Source:
    """
    Open a topic: ``mqtt://host/topic``, of JSON, of lines of instruments, or of plain numbers.

    ``field`` is the path of the speed, as ``speed``; ``direction_topic`` is that of a direction
    that comes by itself; ``user`` and ``password_file`` log in.
    """
    topic = address.place.removeprefix('/')
    if 'field' in address.options:
        address.options.setdefault('speed', address.options['field'])
    address.text_of('field')
    read: _Read = lines_of(address)
    vane = address.text_of('direction_topic')
    transport = broker_of(address, (topic, vane) if vane else (topic,))
    expects = 'JSON with a wind speed (say where: field=PATH), or a number'
    return Source(transport, _with_vane(read, vane) if vane else read, topic, expects)


def broker_of(address: SourceAddress, topics: tuple[str, ...]) -> Mqtt:
    """Open topics of the broker of an address; a `ParameterError` without a host or a topic."""
    if not address.host or not topics[0]:
        raise address.error('no host or topic', 'give mqtt://host/topic')
    is_encrypted = address.scheme == 'mqtts'
    return Mqtt(
        address.host,
        topics,
        address.port(TLS_PORT if is_encrypted else PORT),
        address.text_of('user') or unquote(address.parts.username or ''),
        address.secret('password_file') or unquote(address.parts.password or ''),
        is_encrypted,
    )


def _with_vane(read: _Read, topic: str) -> _Read:
    """Return a reader of speeds, with the newest direction of a topic of its own."""
    bearing: float | None = None

    def turned(message: Message) -> Readings:
        nonlocal bearing
        if message.origin == topic:
            bearing = bearing_of(message.data.decode('utf-8', 'replace'))
            return ()
        return [
            replace(each, bearing=bearing) if isinstance(each, WindReading) else each
            for each in read(message)
        ]

    return turned
