# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The face of a house: the names that its ``__init__`` offers, each imported at its first use.

A face states each name once, for people and type checkers, as ``from MODULE import NAME as NAME``
under ``if TYPE_CHECKING``; `face` reads them there (PEP 562). So whoever needs one name of a house
loads what that name needs, and no more of the house.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from pkgutil import get_data
import re
import sys
from typing import Any

_OFFERED = re.compile(r'from ([\w.]+) import (?:\(\s*)?(\w+) as \2\b')


def face(house: str) -> tuple[Callable[[str], Any], Callable[[], list[str]], list[str]]:
    """
    Return ``__getattr__``, ``__dir__`` and ``__all__`` of a house by its ``__name__``.

    Raises
    ------
    AttributeError
        Of ``__getattr__``: a name that the face does not offer.

    """
    source = get_data(house, '__init__.py') or b''
    homes = {name: home for home, name in _OFFERED.findall(source.decode())}

    def offered(name: str) -> Any:
        if name not in homes:
            raise AttributeError(f"module '{house}' has no attribute '{name}'")
        value = getattr(import_module(homes[name]), name)
        setattr(sys.modules[house], name, value)
        return value

    def names() -> list[str]:
        return sorted({*vars(sys.modules[house]), *homes})

    return offered, names, sorted(homes)
