# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What a viewer may change: each control with its range, and how a change is applied."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

from tree_sway.errors import ParameterError, TreeSwayError
from tree_sway.parameters.parameter import Parameter

_GREATEST = 1e15
Value = bool | float | str | None
"""Value of a control, as JSON has it; None for a button."""


@dataclass(frozen=True)
class Control:
    """
    One thing that a viewer may change.

    Parameters
    ----------
    name
        Its name in messages.
    label, description
        Texts for people.
    value
        Its value now, whose kind (bool, float, str) is the kind that is accepted.
    unit
        SI unit; may be empty.
    minimum, maximum
        Range of a number.
    choices
        Strings that are accepted.
    is_action
        Whether it is a button without a value.

    """

    name: str
    label: str
    value: Value
    description: str = ''
    unit: str = ''
    minimum: float | None = None
    maximum: float | None = None
    choices: tuple[str, ...] = ()
    is_action: bool = False

    @classmethod
    def of(cls, parameter: Parameter, label: str, value: Value = None) -> Control:
        """Make the control of a parameter, at its default if no value is given."""
        value = parameter.default if value is None else value
        limits = parameter.minimum, parameter.maximum, parameter.choices
        return cls(parameter.name, label, value, parameter.description, parameter.unit, *limits)

    def checked(self, value: object) -> Value:
        """
        Convert a value that came from outside.

        Raises
        ------
        ParameterError
            Wrong kind, not finite, out of range, not among the choices; says what is right.

        """
        if self.is_action:
            return None
        if isinstance(value, int | float) and not abs(value) < _GREATEST:
            raise ParameterError('a number out of range', where=self.name)
        limits = self.minimum, self.maximum, self.choices
        known = Parameter(self.name, self.value, self.description, self.unit, *limits)
        checked: Value = known.checked(value)
        return checked


PAUSE_AND_RESET = (
    Control('pause', 'Pause', False, 'Time stops.'),
    Control('reset', 'Reset', None, 'Back to rest.', is_action=True),
)


class ControlPanel:
    """
    All controls, and what carries changes out.

    Parameters
    ----------
    controls
        What may be changed.
    apply
        Called with name and checked value; raises `TreeSwayError` to refuse.

    """

    def __init__(
        self, controls: tuple[Control, ...] = (), apply: Callable[[str, Value], None] | None = None
    ) -> None:
        self._controls = {control.name: control for control in controls}
        self._apply = apply

    def entries(self) -> list[dict[str, object]]:
        """All controls as JSON has them."""
        return [vars(control) for control in self._controls.values()]

    def values(self) -> dict[str, Value]:
        """Values by name, actions left out."""
        return {c.name: c.value for c in self._controls.values() if not c.is_action}

    def update(self, values: Mapping[str, Value]) -> None:
        """Note values that were changed from elsewhere; names that are no control are left out."""
        for name, value in values.items():
            if name in self._controls:
                self._controls[name] = replace(self._controls[name], value=value)

    def set(self, name: object, value: object) -> str | None:  # noqa: A003
        """Change something; returns why not, None if it was done."""
        control = self._controls.get(name) if isinstance(name, str) else None
        if control is None or self._apply is None:
            return f"nothing called '{str(name)[:40]}' can be changed here"
        try:
            checked = control.checked(value)
            self._apply(control.name, checked)
        except TreeSwayError as error:
            return str(error)
        if not control.is_action:
            self._controls[control.name] = replace(control, value=checked)
        return None
