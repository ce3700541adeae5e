# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``tree-sway calibrate``: fit a tree's modulus and damping to one measured sway."""

from __future__ import annotations

import argparse
import math
from pathlib import Path
import shlex
import time

from tree_sway.commands import say, waiting
from tree_sway.core.checks import within
from tree_sway.core.settings import Settings
from tree_sway.core.setup import is_in_leaf
from tree_sway.core.species import Species, species_named
from tree_sway.errors import inside, ParameterError, TransportError
from tree_sway.files import path_of
from tree_sway.files.commands import (
    add_leaves_argument,
    add_output_arguments,
    add_tree_arguments,
    chosen_leaves,
    opened_tree,
    output_path,
    say_warnings,
    write_tree_file,
)
from tree_sway.files.trees import sway_oddity
from tree_sway.files.wind import read_csv_sway, read_phone_sway, SwayRecord
from tree_sway.identification import calibrate, estimate_sway
from tree_sway.identification.calibration import Calibration
from tree_sway.identification.free_decay import FreeDecay

_YAML = ('.yaml', '.yml')
_PERIOD = 1.0
"""Interval of reading the measurement of a phone [s]."""
_WOOD = (0.3e9, 200e9)
"""A modulus outside of this [Pa] is ten times beyond any green wood's."""
_UNUSUAL = 1.5
"""Factor on the usual modulus of a species beyond which the cause is mostly elsewhere."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    add = parser.add_argument
    add_tree_arguments(parser)
    add_leaves_argument(parser)
    add('--frequency', type=float, metavar='HZ', help='measured slowest sway [Hz]')
    add(
        '--damping',
        type=float,
        metavar='Z',
        help='measured damping ratio [-]; overrides the value from the record',
    )
    add(
        '--record',
        metavar='FILE',
        help='recorded sway: CSV with time and x, y or tilt_x or ax ...; or http://... of a '
        'phone that measures with phyphox',
    )
    add(
        '--seconds',
        type=float,
        default=0.0,
        metavar='N',
        help='duration of the measurement by phone [s]',
    )
    add(
        '--branch',
        metavar='NAME',
        help='measured branch, such as stem; else the slowest sway is fitted',
    )
    add(
        '--band',
        type=float,
        nargs=2,
        metavar=('LOW', 'HIGH'),
        help='frequency band of the record in which to search for the sway [Hz]',
    )
    add_output_arguments(parser, 'tree with the fitted wood to write: .yaml')


def run(arguments: argparse.Namespace) -> int:
    """Fit the tree and write it."""
    output = output_path(arguments)
    _check(arguments)
    tree_file = opened_tree(arguments)
    frequency = arguments.frequency
    damping = arguments.damping
    error = 0.0
    if arguments.record is not None:
        found = _measured(arguments)
        frequency = found.frequency
        error = found.frequency_error / found.frequency
        damping = found.damping_ratio if damping is None else damping
    settings = Settings(in_leaf=chosen_leaves(arguments))
    with waiting('calibrating'):
        fitted = calibrate(tree_file.tree, tree_file.species, frequency, damping, settings,
                           arguments.branch)  # fmt: skip
    if not _WOOD[0] <= fitted.species.modulus <= _WOOD[1]:
        raise ParameterError(
            f'{frequency:.4g} Hz would take a modulus of {fitted.species.modulus / 1e9:.4g} GPa, '
            'where green wood has 3 to 20',
            where=tree_file.source,
            cure='check the frequency, the density, the diameters, and which branch swayed',
        )
    in_leaf = is_in_leaf(tree_file.species, settings.in_leaf)
    oddity = sway_oddity(tree_file.tree, fitted.species, fitted.frequency)
    new = set(tree_file.of_species(fitted.species).warnings) - set(tree_file.warnings)
    say_warnings([*sorted(new), *([oddity] if oddity else [])])
    if arguments.branch is None and fitted.branch != tree_file.tree.branch_names[0]:
        stem = tree_file.tree.branch_names[0]
        say(f'this sway is of a limb; one measured on the stem: --branch {stem}')
    for line in _changes(tree_file.species, fitted, error, damping, in_leaf=in_leaf):
        print(line)
    write_tree_file(output, tree_file.tree, fitted.species)
    print(f'Next: tree-sway show {shlex.quote(str(output))}  # shows how it sways now')
    return 0


def _check(arguments: argparse.Namespace) -> None:
    """Check the arguments before slow work."""
    if (arguments.frequency is None) == (arguments.record is None):
        given = 'both' if arguments.record is not None else 'neither'
        raise ParameterError(f'{given} of --frequency and --record', cure='give one of the two')
    if arguments.record is None and arguments.band is not None:
        raise ParameterError('no record', where='--band', cure='give --record too')
    if arguments.frequency is not None:
        within('--frequency', arguments.frequency, 0.0, 1e3, 'Hz', above=True)
    if arguments.damping is not None:
        within('--damping', arguments.damping, 0.0, 1.0)
    if Path(arguments.output).suffix.lower() not in _YAML:
        raise ParameterError(
            f"'{arguments.output}' cannot store wood", where='--output', cure='write a .yaml file'
        )


def _measured(arguments: argparse.Namespace) -> FreeDecay:
    """Return the result of the record, and print it."""
    record = _recorded(arguments.record, arguments.seconds)
    band = None if arguments.band is None else (arguments.band[0], arguments.band[1])
    with inside(record.source):
        found = estimate_sway(record.time, record.motion, band)
    print(
        f'Measured in {record.source}: {record.quantity} of {", ".join(record.columns)}, '
        f'{found.cycles:.0f} swings after the release'
    )
    for note in record.notes:
        say(note)
    print(
        f'  swing      {_swing(found.frequency)}{_within(found.frequency_error / found.frequency)}'
    )
    own_error = found.damping_error / max(found.damping_ratio, 1e-9)
    print(
        f'  damping    {found.damping_ratio:.3g}{_within(own_error)}: '
        f'each swing is {_shrinks(found.damping_ratio)} smaller than the one before'
    )
    return found


def _recorded(source: str, seconds: float) -> SwayRecord:
    """Read a file, or wait until a phone has measured for some time [s]."""
    if not source.startswith(('http://', 'https://')):
        return read_csv_sway(path_of(source), 0.0)  # a release is whole
    measured = -1.0
    with waiting('listening to the phone'):
        while True:
            record = read_phone_sway(source)
            before = measured
            measured = float(record.time[-1] - record.time[0])
            if measured >= seconds:
                return record
            if measured == before:
                what = f'{measured:.1f} s are measured, and the measurement has stopped'
                raise TransportError(what, where=source, cure='start the experiment in phyphox')
            time.sleep(_PERIOD)


def _changes(
    before: Species, fitted: Calibration, error: float, damping: float | None, *, in_leaf: bool
) -> list[str]:
    """Tell what changed; `error` is the relative standard error of the frequency."""
    after = fitted.species
    table = species_named(before.key)
    was_stable = fitted.frequency_before is not None
    was = _swing(fitted.frequency_before) if was_stable else 'could not stand'
    usual = after.modulus / table.modulus
    season, leaves = ('damping_in_leaf', 'in leaf') if in_leaf else ('damping_bare', 'bare')
    lines = [
        'Changed, so that the tree of the file sways as measured; its shape stays:',
        f"  swing      {was} -> {_swing(fitted.frequency)}, most in branch '{fitted.branch}'",
        f'  stiffness  modulus of the wood {before.modulus / 1e9:.3g} -> '
        f'{after.modulus / 1e9:.4g} GPa{_within(fitted.sensitivity * error)}: {usual:.3g} times '
        f'the usual one of {table.title}{" (an estimate)" if table.is_estimate else ""}',
    ]
    if not 1.0 / _UNUSUAL <= usual <= _UNUSUAL:
        lines.append(
            '             that is far from usual: first check the diameters, the leaves, and '
            'whether this branch swayed'
        )
    if math.isfinite(after.root_stiffness):
        lines.append(
            f'  roots      {before.root_stiffness:.3g} -> {after.root_stiffness:.3g} N m/rad, '
            'in proportion to the modulus'
        )
    own = getattr(after, season)
    if damping is None:
        lines.append(
            f'  damping    stays {own:.3g} {leaves}, as it was not measured: --damping, or '
            '--record of a release'
        )
    else:
        lines.append(
            f'  damping    {getattr(before, season):.3g} -> {own:.3g} {leaves}: how soon it comes '
            'to rest; measured in wind or in wide swings it is too high, as air brakes too'
        )
    return lines


def _swing(frequency: float | None) -> str:
    """Return a frequency [Hz] with the time of a swing; there is one."""
    assert frequency is not None
    return f'{frequency:.4g} Hz (back and forth in {1.0 / frequency:.3g} s)'


def _within(error: float) -> str:
    """Return a relative error as words, empty for none."""
    return f' within {max(100.0 * error, 0.1):.1f} %' if error > 0.0 else ''


def _shrinks(damping: float) -> str:
    """Return the share by which a swing is smaller than the one before."""
    share = 1.0 - math.exp(-math.tau * damping / math.sqrt(max(1.0 - damping**2, 1e-9)))
    return f'{100.0 * share:.0f} %'
