# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Controls for viewers: each with its range, and the application of changes."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

from tree_sway.core.checks import within
from tree_sway.core.settings import STIFFEST
from tree_sway.errors import ParameterError, TreeSwayError
from tree_sway.parameters import Parameter
from tree_sway.stream.check_description import Json

_GREATEST = 1e15
_FARTHEST = 1e5
Value = bool | float | str | None
"""Value of a control, as in JSON; None for a button."""


Refused = Callable[[str], None]
"""Function called with the reason of a refusal, from any thread."""

_Pull = Callable[[int, tuple[float, ...], float, Refused], None]
"""
Pull at a segment towards a place [m], (3,), by a stiffness [N/m]; 0 releases it.

The last argument is called if the pull is refused later, when it is applied.
"""


@dataclass(frozen=True)
class Control:
    """
    A value that a viewer may change.

    Parameters
    ----------
    name
        Name of the control in messages.
    label, description
        Texts for people.
    value
        Present value, whose type (bool, float, str) is the type of accepted values.
    unit
        SI unit; may be empty.
    minimum, maximum
        Range of a number.
    choices
        Accepted strings.
    is_action
        True for a button without a value.

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
        """Make the control of a parameter, with its default if no value is given."""
        value = parameter.default if value is None else value
        limits = parameter.minimum, parameter.maximum, parameter.choices
        return cls(parameter.name, label, value, parameter.description, parameter.unit, *limits)

    def checked(self, value: object) -> Value:
        """
        Convert an external value.

        Raises
        ------
        ParameterError
            A wrong type, not finite, out of range, not among the choices; with the accepted
            values.

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
    All controls, and the functions that apply changes.

    Parameters
    ----------
    controls
        Controls that may be changed.
    apply
        Function called with name and checked value; raises `TreeSwayError` to refuse.
    pull
        Function called for a branch that a viewer drags; None if branches cannot be pulled.

    """

    def __init__(
        self,
        controls: tuple[Control, ...] = (),
        apply: Callable[[str, Value], None] | None = None,
        pull: _Pull | None = None,
    ) -> None:
        self._controls = {control.name: control for control in controls}
        self._apply = apply
        self._pull = pull
        self.can_pull = pull is not None
        """Whether a branch can be pulled."""

    def entries(self) -> list[Json]:
        """All controls for JSON."""
        return [vars(control) for control in self._controls.values()]

    def values(self) -> dict[str, Value]:
        """Values by name, without actions."""
        return {c.name: c.value for c in self._controls.values() if not c.is_action}

    def update(self, values: Mapping[str, Value]) -> None:
        """Set values that were changed elsewhere; unknown names are ignored."""
        for name, value in values.items():
            if name in self._controls:
                self._controls[name] = replace(self._controls[name], value=value)

    def set(self, name: object, value: object) -> str | None:  # noqa: A003
        """Change a value; returns the reason of a refusal, or None."""
        control = self._controls.get(name) if isinstance(name, str) else None
        if control is None or self._apply is None:
            return f"there is no control '{str(name)[:40]}'"
        try:
            checked = control.checked(value)
            self._apply(control.name, checked)
        except TreeSwayError as error:
            return str(error)
        if not control.is_action:
            self._controls[control.name] = replace(control, value=checked)
        return None

    def pull(self, given: object, refused: Refused) -> str | None:
        """
        Pull at a segment for a viewer.

        Parameters
        ----------
        given
            Request of the viewer, from JSON.
        refused
            Function called with the reason if it is refused later.

        Returns
        -------
        str | None
            Reason of a refusal now, or None.

        """
        if self._pull is None:
            return 'no branch can be pulled here'
        try:
            match given:
                case {
                    'segment': int(segment),
                    'to': [_, _, _] as to,
                    'stiffness': stiffness,
                } if all(map(_is_number, (segment, *to, stiffness))):
                    far = tuple(within('pull: to', x, -_FARTHEST, _FARTHEST, 'm') for x in to)
                    stiff = within('pull: stiffness', stiffness, 0.0, STIFFEST, 'N/m')
                    self._pull(segment, far, stiff, refused)
                case _:
                    return 'a pull has a segment, a place to pull it to, and a stiffness'
        except TreeSwayError as error:
            return str(error)
        return None


def _is_number(value: object) -> bool:
    """Whether a value of JSON is a number; true and false are none."""
    return type(value) in (int, float)
