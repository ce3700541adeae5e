# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The line between sites: keys of Zenoh, whose payloads are messages of ROS, JSON, and frames.

========================= ====================================================
``PREFIX/wind/filtered``   the gated wind, ``geometry_msgs/Vector3Stamped`` in CDR
``PREFIX/tree``            answers what sites must agree in, JSON
``PREFIX/snapshot``        answers the state of now, JSON
``PREFIX/description``     answers the description of doc/streaming.md
``PREFIX/frame``           its frames
========================= ====================================================
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
import json
from typing import Any

from tree_sway_ros.errors import MissingDependencyError, TransportError

_PATIENCE = 5.0


class Line:
    """
    A session of Zenoh; who is on one line under one prefix has one tree.

    Endpoints are such as ``tcp/0.0.0.0:7447``; with none, peers find each other in the local net.

    Raises
    ------
    MissingDependencyError
        If eclipse-zenoh is not installed.
    TransportError
        An endpoint that cannot be used.

    """

    def __init__(
        self, prefix: str, listen: Sequence[str] = (), connect: Sequence[str] = ()
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
            config = zenoh.Config()
            if listen or connect:
                config.insert_json5('scouting/multicast/enabled', 'false')
            config.insert_json5('listen/endpoints', json.dumps(list(listen)))
            config.insert_json5('connect/endpoints', json.dumps(list(connect)))
            self._session: Any = zenoh.open(config)
            self._key('x')
        except zenoh.ZError as error:
            where = ', '.join([*listen, *connect])
            raise TransportError(
                f'the line cannot be opened ({error})',
                where=where,
                cure='give endpoints as tcp/HOST:PORT, one side listening',
            ) from error

    def put(self, key: str, data: bytes) -> None:
        """Send bytes to whoever hears a key."""
        self._session.put(self._key(key), data)

    def hear(self, key: str, take: Callable[[bytes], None]) -> None:
        """Have bytes of a key taken, on a thread of the session."""
        self._kept.append(
            self._session.declare_subscriber(
                self._key(key), lambda sample: take(sample.payload.to_bytes())
            )
        )

    def answer(self, key: str, data: Callable[[], str | bytes]) -> None:
        """Answer whoever asks for a key, on a thread of the session; nothing while it is empty."""

        def reply(query: Any) -> None:
            with query:
                if told := data():
                    query.reply(self._key(key), told)

        self._kept.append(self._session.declare_queryable(self._key(key), reply))

    def ask(self, key: str, seconds: float = _PATIENCE) -> bytes | None:
        """First answer for a key within a time [s]; None if there is none."""
        for reply in self._session.get(self._key(key), timeout=seconds):
            if reply.ok is not None:
                return bytes(reply.ok.payload.to_bytes())
        return None

    def close(self) -> None:
        """Close the session."""
        self._session.close()

    def __enter__(self) -> Line:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _key(self, key: str) -> str:
        return f'{self._prefix}/{key}'
