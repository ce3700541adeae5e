# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Writing of messages as bytes into a rosbag2 bag, through rosbags."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
import sqlite3
import time
from typing import Any

from tree_sway.errors import FormatError, ParameterError

FORMATS = ('mcap', 'sqlite3')
"""Kinds of storage."""
_RECOVERY = {
    'mcap': "make room, then 'mcap recover' restores the written part: its index is missing",
    'sqlite3': 'make room; the written part can be read',
}
"""Cure after a full disk, by storage: the index of an MCAP file is at its end."""
COMMIT_EVERY = 1.0
"""Time [s] after which written messages are in the file, however the process ends."""


class BagWriter:
    """
    A bag to write, for ``ros2 bag play``, Foxglove and PlotJuggler.

    Raises
    ------
    ModuleNotFoundError
        If rosbags is not installed.
    ParameterError
        A format that is not one of `FORMATS`.
    FormatError
        An existing folder, or a full disk.

    Examples
    --------
    >>> with BagWriter(Path("bag")) as bag:
    ...     bag.add("/wind", "geometry_msgs/msg/Vector3Stamped")
    ...     bag.write("/wind", stamp, data)

    """

    def __init__(self, path: Path, format: str = 'mcap') -> None:  # noqa: A002
        from rosbags.rosbag2 import StoragePlugin, Writer
        from rosbags.typesys import get_typestore, Stores

        if format not in FORMATS:
            raise ParameterError(f"unknown format '{format}'", cure=f'use {" or ".join(FORMATS)}')
        if path.exists():
            raise FormatError('it is there already', where=str(path), cure='name another folder')
        self._writer = Writer(path, version=9, storage_plugin=StoragePlugin[format.upper()])
        self._format = format
        self._types = get_typestore(Stores.ROS2_JAZZY)
        self._connections: dict[str, object] = {}
        self.counts: dict[str, int] = {}
        self._committed = time.monotonic()

    def add(
        self,
        topic: str,
        type_name: str,
        *,
        reliable: bool = True,
        latched: bool = False,
        depth: int = 1,
    ) -> None:
        """Add a topic of a type ``package/msg/Name``, to be played with the service of `Topic`."""
        from rosbags.interfaces import (
            Qos,
            QosDurability,
            QosHistory,
            QosLiveliness,
            QosReliability,
            QosTime,
        )

        never = QosTime(9223372036, 854775807)
        quality = Qos(
            QosHistory.KEEP_LAST, depth,
            QosReliability.RELIABLE if reliable else QosReliability.BEST_EFFORT,
            QosDurability.TRANSIENT_LOCAL if latched else QosDurability.VOLATILE, never, never,
            QosLiveliness.AUTOMATIC, never, False,
        )  # fmt: skip
        with self._room():
            self._connections[topic] = self._writer.add_connection(
                topic, type_name, typestore=self._types, offered_qos_profiles=[quality]
            )
        self.counts[topic] = 0

    def write(self, topic: str, stamp: int, data: bytes) -> None:
        """Write a message that was received at a time [ns], as its CDR bytes."""
        with self._room():
            self._writer.write(self._connections[topic], stamp, data)  # type: ignore[arg-type]
            self.counts[topic] += 1
            if time.monotonic() - self._committed >= COMMIT_EVERY:
                self._commit()

    def _commit(self) -> None:
        """Flush the storage of rosbags, which has no function for it."""
        storage: Any = self._writer.storage
        if hasattr(storage, 'conn'):
            storage.conn.commit()
        else:
            storage.close_chunk()
            storage.bio.flush()
        self._committed = time.monotonic()

    @contextmanager
    def _room(self) -> Iterator[None]:
        """Close the bag and raise a `FormatError` when the disk is full."""
        try:
            yield
        except (OSError, sqlite3.Error) as error:
            with suppress(OSError, sqlite3.Error):
                self._writer.abort()
            raise FormatError(
                f'cannot be written to: {error}',
                where=str(self._writer.path),
                cure=_RECOVERY[self._format],
            ) from error

    def __enter__(self) -> BagWriter:
        with self._room():
            self._writer.open()
        return self

    def __exit__(self, *_: object) -> None:
        if self._writer.storage is not None:
            with self._room():
                self._writer.close()
