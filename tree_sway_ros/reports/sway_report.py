# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Does the stream keep up, and with which model? What the solver says on `/diagnostics`."""

from __future__ import annotations

import time

from tree_sway.core.scene.demand import adaptive_among
from tree_sway.core.scene.run import Run
from tree_sway.core.scene.scene_simulator import Simulator
from tree_sway.core.wind.gate import GateCounts
from tree_sway.core.wind.gust_travel import GustHistory
from tree_sway_ros.reports.diagnostics import OK, STALE, Status, WARN
from tree_sway_ros.timing.pacer import Pace, Pacer

_WIND = {
    'none': (WARN, 'no wind yet: the tree is at rest'),
    'live': (OK, 'live'),
    'holding': (OK, 'a sample is overdue: the last wind is held'),
    'decaying': (WARN, 'no wind: its force decays'),
    'stale': (STALE, 'no wind: nothing is left of its force'),
}

_SILENCE = 1.0
"""Without a frame for this time [s], by a clock that goes on, the stream is reported as halted."""


class SwayReport:
    """Compares each report with the one before."""

    def __init__(self) -> None:
        self._skipped = 0
        self._frames = 0
        self._time = time.monotonic()

    def statuses(self, run: Run, pacer: Pacer, frames: int) -> list[Status]:
        """Report on the wind, the output and the model, after a number of pose arrays."""
        output = self._output(pacer.pace(), 1e9 / pacer.period, frames, pacer.is_simulated)
        statuses = [_wind(run.wind_state, run.counts), output, _model(run.simulator)]
        gusts = run.simulator.gusts
        return statuses if gusts is None else [*statuses, _gusts(gusts)]

    def _output(self, pace: Pace, rate: float, frames: int, is_simulated: bool) -> Status:
        now = time.monotonic()
        published = (frames - self._frames) / max(1e-9, now - self._time)
        skipped = pace.skipped - self._skipped
        self._time, self._frames, self._skipped = now, frames, pace.skipped
        values = {**pace._asdict(), 'wanted': rate, 'published': published, 'frames': frames}
        if pace.silence > max(_SILENCE, 3.0 / rate) and not is_simulated:
            return Status('output', WARN, f'no frame for {pace.silence:.1f} s', values)
        if skipped > 0.01 * rate:
            late = f'{1e3 * pace.late_p95:.1f} ms late (p95)'
            return Status('output', WARN, f'{skipped} frames skipped, {late}', values)
        return Status('output', OK, f'{pace.rate:.1f} Hz', values)


def _wind(state: str, counts: GateCounts) -> Status:
    level, sentence = _WIND[state]
    values = {'state': state, 'refused': counts.refused, **vars(counts)}
    return Status('wind', level, sentence, values)


def _model(simulator: Simulator) -> Status:
    values = {
        'model': simulator.model,
        'branches solved': simulator.n_solved,
        **vars(simulator.counts),
    }
    trees = simulator.simulators
    if trees != (simulator,):
        values |= {f'model of {each.tree.name}': each.model for each in trees}
    outside = sum(each.bank.oscillators.n_outside for each in trees)
    values['steps outside of the wind basis'] = outside
    adaptive = adaptive_among(trees)
    if not adaptive:
        return Status('model', OK, simulator.model, values)
    worst = max(adaptive, key=lambda each: float(each.choice.error / each.tolerance))
    cost, budget = sum(a.frame_cost for a in adaptive), sum(a.budget for a in adaptive)
    values |= {
        'chosen': ', '.join(dict.fromkeys(each.choice.name for each in adaptive)),
        'estimated error [m]': worst.choice.error,
        'tolerance [m]': worst.tolerance,
        'estimated cost [us]': cost,
        'budget [us]': budget,
    }
    if 0.0 < budget < cost:
        what = f'no model is within the budget; allow {cost:.3g} us for {values["chosen"]}'
        return Status('model', WARN, what, values)
    if worst.choice.error > worst.tolerance:
        nearest = f'allow {worst.choice.error:.2g} m for {worst.choice.name}'
        what = f'{worst.tree.name}: no model is within the tolerance; {nearest}'
        return Status('model', WARN, what, values)
    return Status('model', OK, simulator.model, values)


def _gusts(history: GustHistory) -> Status:
    """How late the trees of a forest feel the wind."""
    values = {
        'longest delay [s]': float(history.delay.max()),
        'trees upwind': history.n_ahead,
        'trees beyond the memory': history.n_forgotten,
    }
    if history.n_ahead or history.n_forgotten:
        what = (
            f'{history.n_ahead} trees are upwind of the anemometer and feel the wind at once, '
            f'{history.n_forgotten} are too far downwind and feel the oldest wind kept'
        )
        return Status('gusts', WARN, what, values)
    return Status('gusts', OK, f'up to {values["longest delay [s]"]:.1f} s late', values)
