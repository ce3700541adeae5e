# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Definition of parameters, each once, in ``sway.yaml`` or in the ``nodes.yaml`` of ROS.

The ROS declaration, the check of values and of YAML files, and the table in the README come from
the same definition. Nothing here needs ROS; `declaration` of the nodes puts a table on a node.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
import importlib
import math
from pathlib import Path
from typing import Any

import yaml

from tree_sway.errors import nearest, ParameterError

Value = Any  # bool | int | float | str | tuple[float, ...]

# The C parser, where PyYAML was built with it, is ten times faster.
_LOADER: Any = getattr(yaml, 'CSafeLoader', yaml.SafeLoader)


@dataclass(frozen=True)
class Parameter:
    """
    One parameter of a node.

    Parameters
    ----------
    name
        Name, as in ROS.
    default
        Default, whose type (bool, int, float, str, tuple of floats) is that of accepted values;
        integers are accepted for floats.
    description
        One sentence for people.
    unit
        SI unit, empty if it has none.
    minimum, maximum
        Closed range of a number, of each number of a tuple; None for no bound. In files both
        are ``range``.
    choices
        Accepted strings; empty for any. In files ``module:NAME`` means those of a table of the
        library.
    most
        A number from 0 to this is accepted beside the choices; None for none.
    more
        Further accepted strings, as ``module:NAME`` of a function that returns them; it is called
        for a string that is not among the choices.
    live
        True if it may change while the node runs.
    source
        Source of the default or the range; may be empty.

    """

    name: str
    default: Value
    description: str
    unit: str = ''
    minimum: float | None = None
    maximum: float | None = None
    choices: tuple[str, ...] = ()
    most: int | None = None
    more: str = ''
    live: bool = False
    source: str = ''

    def checked(self, value: Value) -> Value:
        """
        Convert a value to the parameter's kind.

        Raises a `ParameterError` with the accepted values for a wrong type, not finite, out of
        range, not among the choices.
        """
        kind = type(self.default)
        if kind is tuple:
            return self._checked_tuple(value)
        value = _of_kind(kind, value)
        if self.most is not None and type(value) is int:
            value = str(value)
        if type(value) is not kind:
            raise self._error(f'{value!r} is not {_KINDS[kind]}')
        if kind in (float, int):
            self._check_range(value)
        if self.most is not None and str(value).isdecimal() and int(value) <= self.most:
            return value
        if self.choices and value not in self.choices and value not in self._further_choices():
            short = str(value).replace('/msg/', '/')  # both are names of types in ROS
            if short in self.choices:
                return short
            near = nearest(str(value), self.choices)
            raise self._error(f"'{value}' is not among its choices", near and f': {near}')
        return value

    @property
    def range_text(self) -> str:
        """Return the accepted values: ``0 .. 40``, ``to | from``; empty for any value."""
        if self.choices:
            choices = [choice or '""' for choice in self.choices]
            return ' | '.join(choices if self.most is None else [*choices, f'0 .. {self.most}'])
        if self.minimum is None and self.maximum is None:
            return ''
        low = '' if self.minimum is None else f'{self.minimum:g}'
        high = '' if self.maximum is None else f'{self.maximum:g}'
        return f'{low} .. {high}'

    def _further_choices(self) -> Iterable[str]:
        return _named(self.more)() if self.more else ()

    def _checked_tuple(self, value: Value) -> tuple[float, ...]:
        size = len(self.default)
        try:
            numbers = tuple(float(item) for item in value)
        except (TypeError, ValueError):
            numbers = ()
        if isinstance(value, str | bytes) or len(numbers) != size:
            raise self._error(f'{value!r} is not {size} numbers')
        for number in numbers:
            self._check_range(number)
        return numbers

    def _check_range(self, value: float) -> None:
        if not math.isfinite(value):
            raise self._error(f'{value} is not finite')
        below = self.minimum is not None and value < self.minimum
        above = self.maximum is not None and value > self.maximum
        if below or above:
            raise self._error(f'{value:g} is out of range')

    def _error(self, what: str, advice: str = '') -> ParameterError:
        limits = f' {self.range_text}' if self.range_text else f' {_KINDS[type(self.default)]}'
        unit = f' [{self.unit}]' if self.unit else ''
        cure = f'give{limits}{unit}{advice}'
        return ParameterError(what, where=f"parameter '{self.name}'", cure=cure)


def _of_kind(kind: type, value: Value) -> Value:
    """Return a value as the intended type, if it is unique: 40 for 40.0, 1 for true."""
    if kind is float and isinstance(value, int) and not isinstance(value, bool):
        return float(value)
    if kind is int and isinstance(value, float) and value.is_integer():
        return int(value)
    if kind is bool and str(value).lower() in _TRUTH:
        return _TRUTH[str(value).lower()]
    return value


_TRUTH = {'true': True, '1': True, 'false': False, '0': False}
_KINDS = {bool: 'true or false', int: 'a whole number', float: 'a number', str: 'a string'}
_KINDS[tuple] = 'a list of numbers'

Table = tuple[Parameter, ...]


def read_tables(path: Path, shared: Table = ()) -> dict[str, Table]:
    """Read a YAML file of the package; a name without keys refers to a shared parameter."""
    by_name = {parameter.name: parameter for parameter in shared}
    content = _LOADER(path.read_text(encoding='utf-8')).get_single_data()
    return {
        key: tuple(_read(name, body) if body else by_name[name] for name, body in table.items())
        for key, table in content.items()
    }


def _read(name: str, body: Mapping[str, Any]) -> Parameter:
    minimum, maximum = body.get('range', (None, None))
    keys: dict[str, Any] = {
        key: tuple(value) if isinstance(value, list) else value
        for key, value in body.items()
        if key not in ('range', 'choices')
    }
    keys['choices'] = tuple(each for entry in body.get('choices', ()) for each in _choices(entry))
    return Parameter(name, minimum=minimum, maximum=maximum, **keys)


def _choices(entry: str) -> Iterable[str]:
    return _named(entry) if ':' in entry else (entry,)


def _named(entry: str) -> Any:
    """Return the object that ``module:NAME`` refers to."""
    module, _, name = entry.partition(':')
    return getattr(importlib.import_module(module), name)
