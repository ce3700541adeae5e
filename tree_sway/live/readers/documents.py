# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The wind of a document of JSON: of a sender whose units are known, or by names."""

from __future__ import annotations

from typing import Any

from tree_sway.files.wind import Readings
from tree_sway.live.readers.named_values import WindNames
from tree_sway.live.readers.tempest import is_tempest, read_tempest
from tree_sway.live.readers.weatherlink import conditions_of, read_weatherlink

_KIND = 'JSON'


def read_document(document: Any, names: WindNames) -> Readings:
    """Read a document; nothing of None. Where ``names`` have a path, that decides."""
    if document is None:
        return ()
    if not names.speed:
        if is_tempest(document):
            return read_tempest(document)
        if conditions_of(document):
            return read_weatherlink(document)
    return names.read(document, _KIND)
