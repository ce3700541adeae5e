# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Layouts of tables of wind, in the order in which they are tried; a new one is a line here."""

from __future__ import annotations

from collections.abc import Sequence

from tree_sway.files.wind.layouts.badc_csv import BADC_CSV
from tree_sway.files.wind.layouts.cumulus import CUMULUS_LOG, CUMULUS_REALTIME
from tree_sway.files.wind.layouts.energyplus import EPW
from tree_sway.files.wind.layouts.isd import ISD_CSV, ISD_LITE
from tree_sway.files.wind.layouts.jma import JMA
from tree_sway.files.wind.layouts.json_tables import JSON
from tree_sway.files.wind.layouts.layout import Layout
from tree_sway.files.wind.layouts.long import LONG
from tree_sway.files.wind.layouts.meteoblue import METEOBLUE
from tree_sway.files.wind.layouts.plain import PLAIN
from tree_sway.files.wind.layouts.spaced import SPACED
from tree_sway.files.wind.layouts.tagged import TAGGED
from tree_sway.files.wind.layouts.toa5 import TOA5
from tree_sway.files.wind.layouts.weatherlink_text import WEATHERLINK_TEXT

LAYOUTS = (
    *(TOA5, JSON, SPACED, WEATHERLINK_TEXT, ISD_CSV, ISD_LITE, BADC_CSV),
    *(TAGGED, CUMULUS_LOG, CUMULUS_REALTIME, EPW, JMA, METEOBLUE),
    *LONG,
    PLAIN,
)


def layout_of(lines: Sequence[str]) -> Layout | None:
    """Return the layout of a table of wind by its first lines; None if it is none."""
    return next((layout for layout in LAYOUTS if layout.recognise(lines)), None)


def looks_like_wind(head: str) -> bool:
    """Whether the beginning of a file is that of a table of wind."""
    lines = head.replace('\r\n', '\n').replace('\r', '\n').split('\n')
    found = layout_of(lines[:200])
    if found is JSON:
        return 'wind' in head.lower() or 'wd' in head
    return found is not None
