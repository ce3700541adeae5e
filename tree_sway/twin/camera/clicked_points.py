# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What a person tells of a camera, as text: clicks, and what is known of where it stands."""

from __future__ import annotations

import math
from typing import NamedTuple

from tree_sway.errors import nearest, ParameterError
from tree_sway.twin.camera.camera_pose import Click, Told

_LATEST = 1.0
_LARGEST = 1e6
"""Number beyond which none is a place in a picture, or told of a camera."""


class ToldCamera(NamedTuple):
    """Clicks, what is known, how late pictures are in [s], and a file for a picture to check."""

    clicks: list[Click]
    told: Told
    late: float
    check: str


def told_by(text: str) -> ToldCamera:
    """
    Read ``bearing=240; distance=14; 640,705,0; 652,210,6.5; 800,300,b12:0.9``.

    Parts are parted by semicolons or lines: ``x,y,PLACE``, the place as `place_on` takes it, or
    ``bearing`` [degrees], ``distance`` [m], ``height`` [m], ``focal`` [pixels], ``late`` [s] and
    ``check``, a file. What follows # is a comment.

    Raises
    ------
    ParameterError
        A part of another form.

    """
    clicks, known, check = list[Click](), dict[str, float](), ''
    lines = [line.partition('#')[0] for line in text.splitlines()]
    for part in filter(None, (each.strip() for each in ';'.join(lines).split(';'))):
        name, equals, value = (each.strip() for each in part.partition('='))
        if name == 'check':
            check = value
        elif equals:
            if name not in (names := [*Told._fields, 'late']):
                cure = nearest(name, names) or f'use {", ".join(names)} or check'
                raise ParameterError(f"'{name}' is not known of a camera", where='--at', cure=cure)
            known[name] = _number(value, part)
        else:
            fields = part.split(',', 2)
            if len(fields) != 3:
                cure = "give x,y,PLACE in pixels and a place, as '640,705,0' or '800,300,b12:0.9'"
                raise ParameterError(f"'{part[:40]}' is no clicked point", where='--at', cure=cure)
            clicks.append(Click(_number(fields[0], part), _number(fields[1], part), fields[2]))
    for name in ('distance', 'focal'):
        if known.get(name, 1.0) <= 0.0:
            raise ParameterError(f'{name}={known[name]:g}', where='--at', cure='give more than 0')
    late = known.pop('late', 0.0)
    if not 0.0 <= late <= _LATEST:
        cure = f'give 0 to {_LATEST:g} s'
        raise ParameterError(f'late={late:g}', where='--at', cure=cure)
    return ToldCamera(clicks, Told(**known), late, check)


def _number(text: str, part: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not abs(value) < _LARGEST:
        cure = 'give numbers as 12.5'
        raise ParameterError(f"'{part[:40]}' has no number", where='--at', cure=cure)
    return value
