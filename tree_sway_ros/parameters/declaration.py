# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Parameters of a node by a table: declaration, checks by our own rules, live changes.

ROS ends a node that is started with ``rate:=40`` where the parameter is a double, and ignores a
misspelt name. Parameters are therefore declared with dynamic typing; types and ranges are checked
here, an unknown name is reported with the nearest one, and a refused change keeps the old value
with a reason.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from typing import Any

from rcl_interfaces.msg import (
    FloatingPointRange,
    IntegerRange,
    ParameterDescriptor,
    SetParametersResult,
)

from tree_sway.errors import nearest, ParameterError, TreeSwayError
from tree_sway.parameters import Parameter, Table, Value

_OF_EVERY_NODE = ('use_sim_time', 'start_type_description_service')
"""Parameters of every node of ROS 2."""
_QUALITY = 'qos_overrides.'
"""Prefix of parameters of the quality of service of a publisher or subscription."""


class ParameterValues:
    """
    The values of a node's parameters, in step with ROS.

    Parameters
    ----------
    node
        Created with ``automatically_declare_parameters_from_overrides=True``, so that all values
        of the user are known, including misspelt names.
    table
        The node's parameters.
    on_change
        Function called with the new values by name after a live change.
    check
        Function called with all new values by name before they are applied, at the start and at
        each change; raises for inconsistent values.

    Raises
    ------
    ParameterError
        A refused value of the user. An unknown name is only a warning: a launch file's
        ``SetParameter`` and a section ``/**`` of a parameter file reach every node.

    """

    def __init__(
        self,
        node: Any,
        table: Table,
        on_change: Callable[[dict[str, Value]], None] = lambda values: None,
        check: Callable[[dict[str, Value]], None] = lambda values: None,
    ) -> None:
        self._by_name = {parameter.name: parameter for parameter in table}
        self._on_change = on_change
        self._check_all = check
        given = {name: item.value for name, item in node.get_parameters_by_prefix('').items()}
        for name in given:
            if name in _OF_EVERY_NODE:
                continue
            # Publishers and subscriptions declare their quality of service.
            if name not in self._by_name and not name.startswith(_QUALITY):
                cure = nearest(name, self._by_name) or f'known are: {", ".join(self._by_name)}'
                where = f"node '{node.get_name()}'"
                error = ParameterError(f"unknown parameter '{name}'", where=where, cure=cure)
                node.get_logger().warning(f'{error}; ignored')
            node.undeclare_parameter(name)
        self._values = {
            each.name: each.checked(given.get(each.name, each.default)) for each in table
        }
        for each in table:
            value = _shown(self._values[each.name])
            node.declare_parameter(each.name, value, _descriptor(each), ignore_override=True)
        check(dict(self._values))
        node.add_pre_set_parameters_callback(self._convert)
        node.add_on_set_parameters_callback(self._check)
        node.add_post_set_parameters_callback(self._apply)

    def __getitem__(self, name: str) -> Value:
        """Value of a parameter in its own type: a float is a float even if ROS was given 40."""
        return self._values[name]

    def subset(self, *names: str) -> dict[str, Value]:
        """Values of some parameters, as keyword arguments."""
        return {name: self._values[name] for name in names}

    def _convert(self, changes: list[Any]) -> list[Any]:
        """Convert each value to the type of its parameter: a double stays one when set to 1."""
        converted = []
        for change in changes:
            with suppress(ParameterError):  # refused later, with the reason
                for name, value in self._checked([change]).items():
                    change = type(change)(name, value=_shown(value))
            converted.append(change)
        return converted

    def _check(self, changes: list[Any]) -> SetParametersResult:
        try:
            self._check_all(self._values | self._checked(changes))
        except TreeSwayError as error:
            return SetParametersResult(successful=False, reason=str(error))
        except Exception as error:  # the caller gets a reply for any error of a rule
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
        if new:
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
    kind = type(parameter.default)
    low = parameter.minimum
    high = parameter.maximum
    if low is None or high is None:
        return descriptor
    if kind is float:
        descriptor.floating_point_range = [FloatingPointRange(from_value=low, to_value=high)]
    elif kind is int:
        descriptor.integer_range = [IntegerRange(from_value=low, to_value=high)]
    return descriptor
