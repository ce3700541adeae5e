# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Read a wind record from a file of any known format.

The content decides, the suffix breaks ties. A new format is one file with a reader, and one line
here.

"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from typing import Any

from tree_sway_ros.errors import FormatError, ParameterError
from tree_sway_ros.files.text_file import path_of, read_head
from tree_sway_ros.files.wind.bag import read_bag_wind
from tree_sway_ros.files.wind.nmea import read_nmea_wind
from tree_sway_ros.files.wind.record import WindRecord
from tree_sway_ros.files.wind.sonic_ascii import read_sonic_wind
from tree_sway_ros.files.wind.table import read_csv_wind, read_toa5_wind


@dataclass(frozen=True)
class WindFormat:
    """
    A format of wind records.

    Parameters
    ----------
    name
        Its name for people and for the ``format`` option.
    suffixes
        Its usual suffixes, lower case.
    content
        Pattern found at the beginning of such a file.
    read
        Its reader.

    """

    name: str
    suffixes: tuple[str, ...]
    content: re.Pattern[bytes]
    read: Callable[..., WindRecord]


_SONIC = re.compile(
    rb"^(\x02[A-Z],|[A-Z],[+-]?\d+(\.\d+)?,[+-]?\d+\.\d+,|S2? +[\d.]+,? +D +\d)", re.M
)

WIND_FORMATS: tuple[WindFormat, ...] = (
    WindFormat("toa5", (".dat", ".toa5"), re.compile(rb'\A"?TOA5"?,'), read_toa5_wind),
    WindFormat("nmea", (".nmea", ".log"), re.compile(rb"\$[A-Z]{5},"), read_nmea_wind),
    WindFormat("sonic", (), _SONIC, read_sonic_wind),
    WindFormat(
        "bag", (".db3", ".mcap"), re.compile(rb"\A(SQLite format 3\0|\x89MCAP0\r\n)"), read_bag_wind
    ),
    WindFormat(
        "csv",
        (".csv", ".tsv", ".txt"),
        re.compile(rb"^[^#\n]*\b(time|t|timestamp|stamp|datetime)\b[^\n]*[,;\t]", re.I | re.M),
        read_csv_wind,
    ),
)

EXAMPLES = ("canopy",)
"""Winds that come with the package: five minutes of a sonic anemometer over a canopy, 20 Hz."""


def read_wind(path: str | Path, format: str | None = None, **options: Any) -> WindRecord:
    """
    Read a wind record.

    Parameters
    ----------
    path
        The file, or the folder of a bag, or one of `EXAMPLES`.
    format
        Name of its format; found from content and suffix if None.
    **options
        What the reader of the format takes, such as ``topic`` or ``rate``.

    Raises
    ------
    FormatError
        A file of no known format, or one without a good row of wind.
    ParameterError
        An option that the reader of this format does not have, or has otherwise.

    """
    path = path_of(path)
    if str(path) in EXAMPLES and not path.exists():
        path = Path(str(files("tree_sway_ros.files.wind").joinpath(f"{path}.csv")))
    chosen = _format_of(path) if format is None else _format_named(format)
    known = chosen.read.__annotations__
    for option in options:
        if option not in known:
            names = ", ".join(name for name in known if name not in ("path", "return"))
            raise ParameterError(
                f"format {chosen.name} has no option '{option}'", cure=f"it has: {names}"
            )
    return chosen.read(path, **options)


def _format_named(name: str) -> WindFormat:
    for known in WIND_FORMATS:
        if known.name == name:
            return known
    raise ParameterError(
        f"unknown wind format '{name}'", cure=f"use {', '.join(f.name for f in WIND_FORMATS)}"
    )


def _format_of(path: Path) -> WindFormat:
    if path.is_dir():
        return _format_named("bag")
    head = read_head(path)
    for known in WIND_FORMATS:
        if known.content.search(head):
            return known
    for known in WIND_FORMATS:
        if path.suffix.lower() in known.suffixes:
            return known
    raise FormatError(
        "a file of no known wind format",
        where=str(path),
        cure=f"give one of {', '.join(f.name for f in WIND_FORMATS)}, or say its format",
    )
