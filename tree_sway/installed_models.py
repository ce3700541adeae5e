# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Models of installed packages and annexes, by entry points.

One of the group `tree_sway.models` names a function ``make(model, branches)`` that returns the
`Oscillators` of a tree, from its `SwayModel` on all coordinates and the records of its branches.
The reference model ``full`` comes so, from the laboratory. One of the group `tree_sway.choosers`
names a class of simulators that choose among the coordinates of a `SwayModel` while they run: the
model ``auto``.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from importlib.metadata import entry_points, EntryPoint
from importlib.util import find_spec
from typing import Any

from tree_sway.errors import MissingDependencyError
from tree_sway.extras import line_in_venv, loaded

GROUP = 'tree_sway.models'
_CHOOSERS = 'tree_sway.choosers'
LABORATORY = 'tree_sway_lab'


@cache
def installed_models() -> dict[str, EntryPoint]:
    """Return the entry points of models by their names."""
    return {point.name: point for point in entry_points(group=GROUP)}


def maker_of(model: str) -> Callable[..., Any]:
    """Return the function that makes an installed model; refuse one that is missing."""
    refuse_missing_model(model)
    make: Callable[..., Any] = loaded(installed_models()[model])
    return make


def chooser_of(model: str) -> Callable[..., Any]:
    """Return the class of the simulators of a model that chooses; refuse one that is missing."""
    for point in entry_points(group=_CHOOSERS, name=model):
        chooser: Callable[..., Any] = loaded(point)
        return chooser
    raise MissingDependencyError(
        f"model '{model}' is not installed",
        where='model',
        cure='install tree_sway_ros again, or give a number of coordinates',
    )


def refuse_missing_model(model: str) -> None:
    """Raise a `MissingDependencyError` that says how to install a model of the laboratory."""
    if model not in installed_models():
        install = line_in_venv('lab') or 'pip install ./lab in the checkout'
        fault = 'is not installed'
        verb = 'install it'
        if find_spec(LABORATORY) is not None:
            # Entry points are those of the day of the installation, even of an editable one.
            fault = 'was installed before it had this model'
            verb = 'install it again'
        raise MissingDependencyError(
            f"model '{model}' belongs to the laboratory, which {fault}",
            where='model',
            cure=f'{verb}: {install}; or give a number of coordinates',
        )
