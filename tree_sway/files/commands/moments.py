# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Moments of a sway at which a scene is written, and their files."""

from __future__ import annotations

from collections.abc import Iterator
import math
from pathlib import Path
import re

from tree_sway.commands import bar, refuse_overwriting
from tree_sway.core.checks import within
from tree_sway.core.scene import Run, Simulator
from tree_sway.core.wind import FASTEST_WIND, WindGate, WindIntake
from tree_sway.errors import ParameterError
from tree_sway.files.text_file import finite
from tree_sway.simulation import blow, WindSource

_STEPS_PER_SECOND = 60.0
_LATEST = 86400.0
_MOST = 100_000
_NUMBER = re.compile(r'%0?\d*d')


def moments_of(text: str) -> list[float]:
    """
    Return the moments of ``5`` or ``0:10:0.1``: from, to and every [s], the end included.

    Raises a `ParameterError` for anything else.
    """
    numbers = [*map(finite, text.split(':'))]
    if len(numbers) not in (1, 3) or None in numbers:
        raise ParameterError(
            f"'{text}' names no moments",
            where='--at',
            cure='give a time such as 5, or from, to and every such as 0:10:0.1',
        )
    start = within('--at', numbers[0], 0.0, _LATEST, 's')
    if len(numbers) == 1:
        return [start]
    end = within('--at: the end', numbers[1], start, _LATEST, 's')
    every = within('--at: every', numbers[2], 0.0, _LATEST, 's', above=True)
    count = math.floor((end - start) / every + 1e-9) + 1
    within('--at: number of moments', count, 1, _MOST)
    return [start + k * every for k in range(count)]


def frame_times(rate: float, seconds: float) -> list[float]:
    """Return the times of frames at a rate [Hz] up to a length [s], the first after a frame."""
    return [k / rate for k in range(1, max(1, round(seconds * rate)) + 1)]


def numbered_paths(pattern: str, count: int, *, may_overwrite: bool) -> list[Path]:
    """
    Return the files of a number of moments, by a pattern such as ``scene_%03d.obj``.

    Raises a `ParameterError` for several moments in one file, or a file that exists.
    """

    def named(number: int) -> str:
        return _NUMBER.sub(lambda form: str(form[0] % number), pattern)

    names = [*map(named, range(count))]
    if len({*names}) < count:
        raise ParameterError(
            f'{count} moments in one file',
            where=pattern,
            cure='name files with a number in their names, such as scene_%03d.obj',
        )
    for name in () if may_overwrite else names:
        refuse_overwriting(name, '--output')
    return [*map(Path, names)]


def at_moments(
    simulator: Simulator, wind: WindSource, moments: list[float], what: str = 'swaying'
) -> Iterator[tuple[int, float]]:
    """
    Sway a scene from rest and yield the number and the time [s] of each moment as it is reached.

    Steps are at most 1/60 s and end at the moments; only the first moment of several is moved, by
    less than a step.

    Parameters
    ----------
    simulator, wind
        Scene at rest, and the samples of its wind.
    moments
        Times at equal distances, rising [s].
    what
        Label of the progress.

    """
    every = moments[1] - moments[0] if len(moments) > 1 else moments[0] or 1.0
    steps = max(1, math.ceil(_STEPS_PER_SECOND * every - 1e-9))
    run = Run(simulator, steps / every, intake=WindIntake(gate=WindGate(max_speed=FASTEST_WIND)))
    tick = 0
    for number, moment in enumerate(bar(moments, what)):
        until = round(moment * steps / every)
        while tick < until:
            tick += 1
            blow(run, wind, tick * run.period)
        yield number, 1e-9 * tick * run.period
