# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""JSON of files: read or refused, and its values as cells of a table."""

from __future__ import annotations

from collections.abc import Sequence
import json
from typing import Any

from tree_sway.errors import FormatError


def parsed(text: str, kind: str = 'JSON') -> Any:
    """Return a document; a `FormatError` for what is no JSON, or nested too deep."""
    try:
        return json.loads(text)
    except (ValueError, RecursionError) as error:
        raise FormatError(f'not {kind}: {error}', cure='save it again whole') from None


def document_of(lines: Sequence[str], kind: str = 'JSON') -> Any:
    """Return a document of several lines, or a list of those that are one each."""
    try:
        return parsed('\n'.join(lines), kind)
    except FormatError:
        filled = [line for line in lines if line.strip()]
        if not (filled and filled[0].rstrip().endswith('}')):
            raise
        return [parsed(line, kind) for line in filled]


def cell_of(value: Any) -> str:
    """Return a value as a cell; empty for none, and for lists and objects."""
    is_one = value is not None and not isinstance(value, dict | list)
    return str(value).replace('\x1f', ' ').replace('\n', ' ') if is_one else ''


def object_of(value: Any) -> dict[str, Any]:
    """Return an object of JSON; an empty one in place of any other value."""
    return value if isinstance(value, dict) else {}


def list_of(value: Any) -> list[Any]:
    """Return a list of JSON; an empty one in place of any other value."""
    return value if isinstance(value, list) else []
