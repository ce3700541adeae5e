# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Gusts, steps and turns of the wind: pure functions of time that add onto any base wind.

Speeds add along the wind in [m/s]; angles turn it about the vertical in [rad], counter-clockwise
seen from above (REP-103). Gusts pass; steps and turns last. The IEC shapes are those of IEC
61400-1:2005, 6.3.2.

"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tree_sway_ros.core.checks import within

Floats = NDArray[np.float64]

_LARGEST_SPEED = 100.0
_LARGEST_ANGLE = 1e3
_LONGEST = 1e6


def one_minus_cos(time: ArrayLike, amplitude: float, duration: float, start: float = 0.0) -> Floats:
    """
    Return the speed of a 1-cos gust: A/2 (1 - cos(2 pi t/T)).

    Parameters
    ----------
    time
        Times in [s], any shape.
    amplitude
        Largest added speed A in [m/s], reached halfway; negative for a lull.
    duration
        Duration T in [s].
    start
        Time it begins in [s].

    Returns
    -------
    Floats
        Speed to add in [m/s], the shape of `time`.

    Raises
    ------
    ParameterError
        If a value is out of its range.

    """
    _check_speed(amplitude)
    x = _progress(time, duration, start)
    return 0.5 * amplitude * (1.0 - np.cos(2.0 * np.pi * x))


def extreme_operating_gust(
    time: ArrayLike, amplitude: float, duration: float = 10.5, start: float = 0.0
) -> Floats:
    """
    Return the speed of the IEC extreme operating gust, the "Mexican hat".

    It is -0.37 A sin(3 pi t/T) (1 - cos(2 pi t/T)): a dip, a peak of 0.74 A, a dip. IEC
    61400-1:2005, 6.3.2.2, where A = 3.3 s/(1 + 0.1 D/Lambda1).

    Parameters
    ----------
    time
        Times in [s], any shape.
    amplitude
        Gust magnitude A in [m/s].
    duration
        Duration T in [s].
    start
        Time it begins in [s].

    Returns
    -------
    Floats
        Speed to add in [m/s], the shape of `time`.

    Raises
    ------
    ParameterError
        If a value is out of its range.

    """
    _check_speed(amplitude)
    x = _progress(time, duration, start)
    hat = -0.37 * amplitude * np.sin(3.0 * np.pi * x) * (1.0 - np.cos(2.0 * np.pi * x))
    return np.asarray(hat, dtype=np.float64)


def step(time: ArrayLike, amplitude: float, rise: float = 0.0, start: float = 0.0) -> Floats:
    """
    Return the speed of a step that lasts.

    Parameters
    ----------
    time
        Times in [s], any shape.
    amplitude
        Added speed in [m/s].
    rise
        Time over which it rises, linearly, in [s]; 0 is a true step.
    start
        Time it begins in [s].

    Returns
    -------
    Floats
        Speed to add in [m/s], the shape of `time`.

    Raises
    ------
    ParameterError
        If a value is out of its range.

    """
    _check_speed(amplitude)
    if rise == 0.0:
        within("start", start, -_LONGEST, _LONGEST, "s")
        return np.where(np.asarray(time) >= start, float(amplitude), 0.0)
    return amplitude * _progress(time, rise, start)


def direction_change(
    time: ArrayLike, angle: float, duration: float = 6.0, start: float = 0.0
) -> Floats:
    """
    Return the angle of the IEC extreme direction change, a/2 (1 - cos(pi t/T)), that lasts.

    Parameters
    ----------
    time
        Times in [s], any shape.
    angle
        Angle a turned in the end in [rad]; the standard's is 4 atan(s/(U (1 + 0.1 D/Lambda1))).
    duration
        Duration T in [s].
    start
        Time it begins in [s].

    Returns
    -------
    Floats
        Angle to turn by in [rad], the shape of `time`; IEC 61400-1:2005, 6.3.2.4.

    Raises
    ------
    ParameterError
        If a value is out of its range.

    """
    within("angle", angle, -_LARGEST_ANGLE, _LARGEST_ANGLE, "rad")
    return 0.5 * angle * (1.0 - np.cos(np.pi * _progress(time, duration, start)))


def turn(time: ArrayLike, angle: float, duration: float, start: float = 0.0) -> Floats:
    """
    Return the angle of a turn at a constant rate, that lasts.

    Parameters
    ----------
    time
        Times in [s], any shape.
    angle
        Angle turned in the end in [rad]; more than 2 pi goes round.
    duration
        Duration in [s].
    start
        Time it begins in [s].

    Returns
    -------
    Floats
        Angle to turn by in [rad], the shape of `time`.

    Raises
    ------
    ParameterError
        If a value is out of its range.

    """
    within("angle", angle, -_LARGEST_ANGLE, _LARGEST_ANGLE, "rad")
    return angle * _progress(time, duration, start)


def _progress(time: ArrayLike, duration: float, start: float) -> Floats:
    within("duration", duration, 0.0, _LONGEST, "s", above=True)
    within("start", start, -_LONGEST, _LONGEST, "s")
    return np.clip((np.asarray(time, dtype=np.float64) - start) / duration, 0.0, 1.0)


def _check_speed(amplitude: float) -> None:
    within("amplitude", amplitude, -_LARGEST_SPEED, _LARGEST_SPEED, "m/s")
