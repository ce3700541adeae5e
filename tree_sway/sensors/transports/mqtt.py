# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Messages of topics of an MQTT broker, by Eclipse Paho."""

from __future__ import annotations

from dataclasses import dataclass, field
import importlib
import math
from typing import Any

from tree_sway.extras import refuse_missing
from tree_sway.sensors.transports.transport import Message, Receiver

PORT, TLS_PORT = 1883, 8883
"""Ports of MQTT without and with TLS."""
_LARGEST = 65_536
"""Largest message that is delivered [bytes]; larger ones are dropped."""
_LOOK = 0.1
_KEEP_ALIVE = 20
"""Interval [s] in which a broker without messages is asked for a sign of life."""


@dataclass(frozen=True)
class Mqtt:
    """
    A subscription to topics; ``+`` and ``#`` stand for parts of them.

    Raises
    ------
    MissingDependencyError
        paho-mqtt is not installed.

    """

    host: str
    topics: tuple[str, ...]
    port: int = PORT
    user: str = ''
    password: str = field(default='', repr=False)
    is_encrypted: bool = False
    silence: float = math.inf

    def __post_init__(self) -> None:
        """Check that Paho is there."""
        refuse_missing(['paho'], '...')

    def __str__(self) -> str:
        """Return its address."""
        scheme = 'mqtts' if self.is_encrypted else 'mqtt'
        return f'{scheme}://{self.host}:{self.port}/{",".join(self.topics)}'

    def listen(self, receiver: Receiver) -> None:
        """Deliver each message of the topics."""
        client_module: Any = importlib.import_module('paho.mqtt.client')
        client = client_module.Client(client_module.CallbackAPIVersion.VERSION2)
        failures = list[str]()

        def on_connect(_client: Any, _user: Any, _flags: Any, reason: Any, _more: Any) -> None:
            if reason.is_failure:
                failures.append(f'the broker refuses: {reason}')
                return
            receiver.opened()
            client.subscribe([(topic, 0) for topic in self.topics])

        def on_subscribe(_client: Any, _user: Any, _id: Any, reasons: Any, _more: Any) -> None:
            refused = [str(each) for each in reasons if each.is_failure]
            failures.extend(f'the broker refuses the topic: {each}' for each in refused)

        def on_message(_client: Any, _user: Any, message: Any) -> None:
            if len(message.payload) <= _LARGEST:
                receiver.deliver(Message(bytes(message.payload), message.topic))

        client.on_connect = on_connect
        client.on_message = on_message
        client.on_subscribe = on_subscribe
        if self.user:
            client.username_pw_set(self.user, self.password or None)
        if self.is_encrypted:
            client.tls_set()
        client.connect(self.host, self.port, _KEEP_ALIVE)
        try:
            while not receiver.is_over:
                code = client.loop(_LOOK)
                if failures:
                    raise ConnectionError(failures[0])
                if code != client_module.MQTT_ERR_SUCCESS:
                    raise ConnectionError(str(client_module.error_string(code)))
        finally:
            client.disconnect()
