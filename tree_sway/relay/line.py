# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The line between sites: keys of Zenoh, whose payloads are messages of ROS and JSON.

========================= ====================================================
``PREFIX/wind/filtered``   the gated wind, ``geometry_msgs/Vector3Stamped`` in CDR
``PREFIX/snapshot``        answers the state of now, and what sites must agree in, JSON
========================= ====================================================
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
import json
from typing import Any

from tree_sway.errors import MissingDependencyError, TransportError

_PATIENCE = 5.0

LARGEST_MESSAGE = 1 << 22
"""Bytes that are taken at once: more than a snapshot of any tree has."""


class Line:
    """
    A session of Zenoh; who is on one line under one prefix has one tree.

    Endpoints are such as ``tcp/0.0.0.0:7447``; with none, peers find each other in the local net.
    A file of Zenoh's own configuration, JSON5, may set certificates (``transport/link/tls``), a
    user and password (``transport/auth/usrpwd``), and all else that Zenoh knows.

    Raises
    ------
    MissingDependencyError
        If eclipse-zenoh is not installed.
    TransportError
        An endpoint, or a file of configuration, that cannot be used.

    """

    def __init__(
        self,
        prefix: str,
        listen: Sequence[str] = (),
        connect: Sequence[str] = (),
        configuration: str | None = None,
    ) -> None:
        try:
            import zenoh
        except ImportError as error:
            raise MissingDependencyError(
                'the relay needs eclipse-zenoh', cure='pip install eclipse-zenoh'
            ) from error
        self._prefix = prefix.strip('/')
        self._kept: list[Any] = []
        try:
            config = zenoh.Config.from_file(configuration) if configuration else zenoh.Config()
            if listen or connect:
                config.insert_json5('scouting/multicast/enabled', 'false')
            for name, endpoints in (('listen', listen), ('connect', connect)):
                if endpoints:
                    config.insert_json5(f'{name}/endpoints', json.dumps(list(endpoints)))
            self.is_protected = _is_protected(config)
            self._session: Any = zenoh.open(config)
            self._key('x')
        except zenoh.ZError as error:
            where = ', '.join([*listen, *connect, *filter(None, [configuration])])
            raise TransportError(
                f'the line cannot be opened ({error})',
                where=where,
                cure='give endpoints as tcp/HOST:PORT, one side listening',
            ) from error

    def put(self, key: str, data: bytes) -> None:
        """Send bytes to whoever hears a key."""
        self._session.put(self._key(key), data)

    def hear(self, key: str, take: Callable[[bytes], None]) -> None:
        """Have bytes of a key taken, on a thread of the session; large ones are left out."""

        def hand_on(sample: Any) -> None:
            if len(sample.payload) <= LARGEST_MESSAGE:
                take(sample.payload.to_bytes())

        self._kept.append(self._session.declare_subscriber(self._key(key), hand_on))

    def answer(self, key: str, data: Callable[[], str | bytes]) -> None:
        """Answer whoever asks for a key, on a thread of the session; nothing while it is empty."""

        def reply(query: Any) -> None:
            with query:
                if content := data():
                    query.reply(self._key(key), content)

        self._kept.append(self._session.declare_queryable(self._key(key), reply))

    def ask(self, key: str, seconds: float = _PATIENCE) -> bytes | None:
        """First answer for a key within a time [s]; None without one."""
        for reply in self._session.get(self._key(key), timeout=seconds):
            if reply.ok is not None and len(reply.ok.payload) <= LARGEST_MESSAGE:
                return bytes(reply.ok.payload.to_bytes())
        return None

    def __enter__(self) -> Line:
        return self

    def __exit__(self, *_: object) -> None:
        self._session.close()

    def _key(self, key: str) -> str:
        return f'{self._prefix}/{key}'


def _is_protected(config: Any) -> bool:
    """Whether others need a certificate or a password to be on the line."""
    needs = [json.loads(config.get_json(f'transport/{key}') or 'null') for key in _PROTECTION]
    return any(needs)


_PROTECTION = ('link/tls/enable_mtls', 'auth/usrpwd/dictionary_file', 'auth/usrpwd/user')
