# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
What sensors on the real tree tell, in sentences for the page.

A sentence is the key of a text of ``static/words.json`` and the values in it, so that each page
shows it in its language; a text that is no key is shown as it is.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from tree_sway.stream import Json
from tree_sway.twin import LearnedTree, SwayChange

_MOST = 8
_LONGEST = 200


def sensors_told(
    sensors: Sequence[Json],
    *,
    explained: float | None = None,
    band: Sequence[float] | None = None,
    learned: LearnedTree | None = None,
    change: SwayChange | None = None,
) -> Iterator[list[str]]:
    """
    Tell of sensors.

    Parameters
    ----------
    sensors
        State of each, as the status of the page has it.
    explained
        Share of the motion that the wind alone explains.
    band
        Interval that holds the real tip with a probability of 80 %, about the model's [m].
    learned
        What they have taught.
    change
        Change of the sway frequencies.

    """
    if not sensors:
        yield ['sensor_elsewhere']
    for each in sensors[:_MOST]:
        name, problem = each['name'], each['problem'][:_LONGEST]
        if each['in_use'] and not problem:
            residual = '; '.join([f'{each["residual"]:.2f}', *each['notes']])[:_LONGEST]
            yield ['sensor_followed', name, f'{each["rate"]:.0f}', residual]
        else:
            yield [problem if problem.startswith(name) else f'{name}: {problem}']
    if any(each['in_use'] for each in sensors):
        if explained is not None:
            by_wind = round(100.0 * explained)
            yield ['shares', str(by_wind), str(100 - by_wind)]
        if band is not None:
            yield ['band_of_tip', *(f'{100.0 * each:.1f}' for each in band)]
    if learned is not None:
        yield ['learned_sway', f'{learned.frequency:.3f}', f'{learned.hours:.2f}']
    if change is not None:
        hours = f'{change.hours:.1f}'
        if (other := change.changed_band) is not None:
            power = [f'{other.power:.2g}', f'{other.low:.2f}', f'{other.high:.2f}']
            yield ['sways_with_other_power', *power, hours]
        else:
            how = 'sways_differently' if change.is_change else 'sways_as_before'
            yield [how, f'{100.0 * (change.ratio - 1.0):+.1f}', hours]
