# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``tree-sway render``: a tree in wind as a moving picture, without a screen."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from io import BytesIO
import time

from tree_sway.commands import say, waiting
from tree_sway.core.checks import within
from tree_sway.files.commands import (
    add_output_arguments,
    add_sway_arguments,
    at_moments,
    chosen_leaves,
    frame_times,
    opened_scene,
    opened_wind,
    output_path,
    refuse_unused_wind,
)
from tree_sway.page import browser, page_pictures

_LEAVES = 2800
"""Share of the leaves, so that frames are drawn fast enough."""
_TRIED = 3
"""Pictures after which it is said how long the others take; the first one sets up."""
_LONG = 20.0
"""Time [s] from which on this is said."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    add = parser.add_argument
    add_sway_arguments(parser)
    add(
        '--seconds',
        type=float,
        default=4.0,
        metavar='N',
        help='duration of the film [s] (%(default)s)',
    )
    add('--rate', type=float, default=20.0, help='pictures per second [Hz] (%(default)s)')
    add('--pixels', type=int, default=480, help='height of the picture in pixels (%(default)s)')
    add_output_arguments(parser, 'film to write: .gif, .webp or .mp4')


def run(arguments: argparse.Namespace) -> int:
    """Sway the tree, paint it, and print the time taken."""
    for name, low, high in (('seconds', 0.1, 3600.0), ('rate', 1.0, 120.0), ('pixels', 64, 4320)):
        within(f'--{name}', getattr(arguments, name), low, high)
    refuse_unused_wind(arguments)
    from tree_sway.pictures.animation import animate_poses, check_film, write_pictures

    target = check_film(output_path(arguments))
    scene = opened_scene(arguments)
    wind = opened_wind(arguments)
    with waiting('setting up the tree'):
        simulator = scene.simulator(in_leaf=chosen_leaves(arguments), model=arguments.model)
    began = time.monotonic()
    rate = arguments.rate
    pixels = arguments.pixels
    count = max(1, round(arguments.seconds * rate))
    why_plain = _why_not_the_page(arguments)
    what = 'swaying' if why_plain else f'drawing {count} pictures'
    times = frame_times(rate, arguments.seconds)
    frames = at_moments(simulator, wind, times, what)
    if not why_plain:
        from PIL import Image

        pictures = page_pictures(simulator, frames, rate, pixels, _LEAVES)
        told = _with_forecast(pictures, count)
        images = (Image.open(BytesIO(each)).convert('RGB') for each in told)
        write_pictures(images, target, rate)
    else:
        say(f'drawn by matplotlib, as {why_plain}')
        shown = [(simulator.place().copy(), simulator.wind.copy()) for _ in frames]
        leaves = scene.leaves(chosen_leaves(arguments), _LEAVES)
        with waiting('painting'):
            poses, winds = zip(*shown, strict=True)
            animate_poses(
                scene.tree, poses, winds, target, rate=rate, leaves=leaves, pixels=pixels
            )
    spent = time.monotonic() - began
    print(
        f'{target}: {scene.name}, {count} pictures, '
        f'{arguments.seconds:g} s of wind in {spent:.1f} s'
    )
    return 0


def _with_forecast(pictures: Iterator[bytes], count: int) -> Iterator[bytes]:
    """Pass pictures on, and say after some of them how long the others take."""
    times = []
    for each in pictures:
        times.append(time.monotonic())
        if len(times) == _TRIED:
            left = (times[-1] - times[0]) / (_TRIED - 1) * (count - _TRIED)
            if left > _LONG:
                say(
                    f'{count} pictures take about {left:.0f} s more; '
                    'a smaller --seconds, --rate or --pixels takes less'
                )
        yield each


def _why_not_the_page(arguments: argparse.Namespace) -> str:
    """Return why the page cannot draw the film; empty if it can."""
    if browser() is None:
        return 'there is no Chromium'
    if not isinstance(arguments.model, int):
        return 'the page draws a --model with a number of coordinates'
    return ''
