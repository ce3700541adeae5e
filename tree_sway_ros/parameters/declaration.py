# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A table of parameters on a node: declared, checked by our own rules, changed while it runs.

ROS kills a node that is started with ``rate:=40`` where the parameter is a double, and silently
ignores a misspelt name. Parameters are therefore declared with dynamic typing; kinds, ranges and
names are checked here, and a refused change keeps the old value and says why.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from rcl_interfaces.msg import (
    FloatingPointRange,
    IntegerRange,
    ParameterDescriptor,
    SetParametersResult,
)

from tree_sway.errors import ParameterError, TreeSwayError
from tree_sway.parameters.parameter import (
    Parameter,
    QOS_PREFIX,
    Table,
    unknown_names,
    unknown_parameter,
    Value,
)

_LARGEST = {float: 1e308, int: 2**62}


class ParameterValues:
    """
    The values of a node's parameters, kept in step with ROS.

    Parameters
    ----------
    node
        Created with ``automatically_declare_parameters_from_overrides=True``, so that what the
        user gave can be seen, misspelt names included.
    table
        The node's parameters.
    on_change
        Called with the new values by name after a live change.
    check
        Called with all values by name, as they would be, before they are taken, at the start and
        at each change; raises where they do not go together.
    is_own
        Whether a name was given to this node alone. What was given to every node of a launch may
        be unknown to this one, or out of its range: then there is a warning, and the default.

    Raises
    ------
    ParameterError
        An unknown name or a refused value among what the user gave to this node.

    """

    def __init__(
        self,
        node: Any,
        table: Table,
        on_change: Callable[[dict[str, Value]], None] | None = None,
        check: Callable[[dict[str, Value]], None] | None = None,
        is_own: Callable[[str], bool] = lambda _name: True,
    ) -> None:
        self._by_name = {parameter.name: parameter for parameter in table}
        self._values: dict[str, Value] = {}
        self._on_change = on_change
        self._check_all = check or (lambda _values: None)
        given = {name: item.value for name, item in node.get_parameters_by_prefix('').items()}
        where = f"node '{node.get_name()}'"
        for name in unknown_names(table, given):
            error = unknown_parameter(table, name, where=where)
            if is_own(name):
                raise error
            node.get_logger().warning(f'{error}; set for every node, ignored here')
            node.undeclare_parameter(name)
        for name in given:
            if name.startswith(QOS_PREFIX):  # declared by the publisher or subscription it is for
                node.undeclare_parameter(name)
        for parameter in table:
            value = parameter.default
            if parameter.name in given:
                node.undeclare_parameter(parameter.name)
                value = given[parameter.name]
            try:
                value = parameter.checked(value)
            except ParameterError as error:
                if is_own(parameter.name):
                    raise
                node.get_logger().warning(f'{error}; set for every node, ignored here')
                value = parameter.default
            self._values[parameter.name] = value
            node.declare_parameter(
                parameter.name, _shown(value), _descriptor(parameter), ignore_override=True
            )
        self._check_all(dict(self._values))
        node.add_pre_set_parameters_callback(self._convert)
        node.add_on_set_parameters_callback(self._check)
        node.add_post_set_parameters_callback(self._apply)

    def __getitem__(self, name: str) -> Value:
        """Value of a parameter, of its own kind: a float is a float even if ROS was given 40."""
        return self._values[name]

    def get(self, name: str, default: Value = None) -> Value:
        """Value of a parameter that not every node has."""
        return self._values.get(name, default)

    def __call__(self, *names: str) -> dict[str, Value]:
        """Values of some parameters, as keyword arguments."""
        return {name: self._values[name] for name in names}

    def _convert(self, changes: list[Any]) -> list[Any]:
        """Give each value its parameter's own kind: a double stays one when set to 1."""
        return [self._converted(change) for change in changes]

    def _converted(self, change: Any) -> Any:
        parameter = self._by_name.get(change.name)
        if parameter is None:
            return change
        try:
            return type(change)(change.name, value=_shown(parameter.checked(change.value)))
        except ParameterError:
            return change  # refused next, with the reason

    def _check(self, changes: list[Any]) -> SetParametersResult:
        try:
            self._check_all(self._values | self._checked(changes))
        except TreeSwayError as error:
            return SetParametersResult(successful=False, reason=str(error))
        except Exception as error:  # the caller gets an answer, whatever a rule stumbles over
            reason = f'cannot be checked: {type(error).__name__}: {error}'
            return SetParametersResult(successful=False, reason=reason)
        return SetParametersResult(successful=True)

    def _checked(self, changes: list[Any]) -> dict[str, Value]:
        return {
            change.name: self._by_name[change.name].checked(change.value)
            for change in changes
            if change.name in self._by_name
        }

    def _apply(self, changes: list[Any]) -> None:
        new = self._checked(changes)
        self._values.update(new)
        if new and self._on_change is not None:
            self._on_change(new)


def _shown(value: Value) -> Any:
    return list(value) if isinstance(value, tuple) else value


def _descriptor(parameter: Parameter) -> ParameterDescriptor:
    unit = f' [{parameter.unit}]' if parameter.unit else ''
    descriptor = ParameterDescriptor(
        description=f'{parameter.description}{unit}',
        additional_constraints=parameter.range_text
        + ('' if parameter.live else ' (read at start only)'),
        read_only=not parameter.live,
        dynamic_typing=True,
    )
    if parameter.minimum is None and parameter.maximum is None:
        return descriptor
    kind = type(parameter.default)
    largest = _LARGEST.get(kind, 0)
    low = -largest if parameter.minimum is None else parameter.minimum
    high = largest if parameter.maximum is None else parameter.maximum
    if kind is float:
        descriptor.floating_point_range = [
            FloatingPointRange(from_value=float(low), to_value=float(high))
        ]
    elif kind is int:
        descriptor.integer_range = [IntegerRange(from_value=int(low), to_value=int(high))]
    return descriptor
