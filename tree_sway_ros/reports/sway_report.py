# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Report of the solver on `/diagnostics`: timing of the stream, wind and model."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
import time

from tree_sway.core.scene import Run, Simulator
from tree_sway.core.wind import GateCounts
from tree_sway.fidelity import adaptive_among
from tree_sway_ros.reports.diagnostics import ERROR, OK, Status, WARN
from tree_sway_ros.reports.one_publisher import named
from tree_sway_ros.reports.sequence_gaps import SequenceGaps
from tree_sway_ros.timing.pacer import Pacer, Timing

_WIND = {
    'none': (WARN, 'no wind yet: the tree is at rest'),
    'live': (OK, 'live'),
    'holding': (OK, 'a sample is overdue: the last wind is used'),
    'decaying': (WARN, 'no wind: its force decays'),
    'stale': (ERROR, 'no wind: its force has decayed'),
}

_SILENCE = 1.0
"""Time without a frame [s], of a running clock, after which the stream is reported as halted."""


class SwayReport:
    """Reports of the solver, each compared with the one before."""

    def __init__(self) -> None:
        self._skipped = 0
        self._frames = self._late = 0
        self.gaps = SequenceGaps()
        """Samples of the wind that were lost on their way to the node."""
        self._time = time.monotonic()

    def statuses(
        self,
        run: Run,
        pacer: Pacer,
        frames: int,
        replay: float | None = None,
        winds: Sequence[str] = ('',),
        poses: Sequence[str] = ('',),
    ) -> list[Status]:
        """
        Report on the wind, the output and the model.

        Parameters
        ----------
        run
            The run of the scene.
        pacer
            Pacer of its steps.
        frames
            Number of published pose arrays.
        replay
            Seconds of the record per second of the machine; None for a live wind.
        winds, poses
            Names of the nodes that publish the wind, and the poses.

        """
        output = self._output(pacer.timing(), 1e9 / pacer.period, frames, pacer.is_simulated)
        wind = _wind(run.wind_state, run.counts)
        wind = self._of_replay(wind, run, replay, self.gaps.report(len(winds)))
        model = _with_reductions(_model(run.simulator), run.simulator)
        return [_mixed(wind, winds), _mixed(output, poses), model]

    def _of_replay(self, wind: Status, run: Run, replay: float | None, lost: int) -> Status:
        """Add the rate of a replay, and samples that are missing or late in it."""
        late = run.late - self._late
        self._late = run.late
        values = {**wind.values, 'lost': self.gaps.lost, 'late': run.late}
        level = wind.level
        text = wind.message
        if replay is not None:
            values['replay rate'] = replay
            text = f'replay at {replay:.2g}x: {text}'
        if lost:
            level = max(level, WARN)
            text = f'{text}; {lost} samples lost on the way'
        if replay is not None and late > 0:
            text = f'{text}; {late} samples came after their time: raise wind_delay or play slower'
            level = max(level, WARN)
        return Status(wind.name, level, text, values)

    def _output(self, timing: Timing, rate: float, frames: int, is_simulated: bool) -> Status:
        now = time.monotonic()
        published = (frames - self._frames) / max(1e-9, now - self._time)
        skipped = timing.skipped - self._skipped
        self._time = now
        self._frames = frames
        self._skipped = timing.skipped
        level = OK
        text = f'{timing.rate:.1f} Hz'
        if timing.silence > max(_SILENCE, 3.0 / rate) and not is_simulated:
            level = WARN
            text = f'no frame for {timing.silence:.1f} s'
        elif skipped > 0.01 * rate:
            late = f'{1e3 * timing.late_p95:.1f} ms late (p95)'
            level = WARN
            text = f'{skipped} frames skipped, {late}'
        values = {**timing._asdict(), 'wanted': rate, 'published': published, 'frames': frames}
        return Status('output', level, text, values)


def _mixed(status: Status, publishers: Sequence[str]) -> Status:
    """Return a status with a warning if several nodes publish its topic."""
    if len(publishers) < 2:
        return status
    text = f'{status.message}; {named(publishers)}, which mix'
    return replace(status, level=max(status.level, WARN), message=text)


def _wind(state: str, counts: GateCounts) -> Status:
    level, sentence = _WIND[state]
    values = {'state': state, 'refused': counts.refused, **vars(counts)}
    return Status('wind', level, sentence, values)


def _with_reductions(status: Status, simulator: Simulator) -> Status:
    """Warn of trees that show fewer coordinates, as their steps stayed clamped."""
    count = simulator.counts.reduced
    if not count:
        return status
    text = f'{status.message}; steps stayed clamped: coordinates were left out {count} times'
    return replace(status, level=WARN, message=f'{text}; a reset brings them back')


def _model(simulator: Simulator) -> Status:
    values = {'model': simulator.model, **vars(simulator.counts)}
    values['gusts'] = simulator.wind_told
    if simulator.gusts is not None:
        values['longest delay of a gust [s]'] = float(simulator.gusts.delay.max())
    trees = simulator.simulators
    if trees != (simulator,):
        values |= {f'model of {each.tree.name}': each.model for each in trees}
    outside = sum(each.banks[0].oscillators.n_outside for each in trees)
    values['steps outside of the wind basis'] = outside
    adaptive = adaptive_among(trees)
    if not adaptive:
        return Status('model', OK, simulator.model, values)
    worst = max(adaptive, key=lambda each: float(each.choice.error / each.tolerance))
    error = worst.choice.error
    cost = sum(each.frame_cost for each in adaptive)
    budget = sum(each.budget for each in adaptive)
    chosen = ', '.join(dict.fromkeys(each.choice.name for each in adaptive))
    values |= {
        'chosen': chosen,
        'estimated error [m]': error,
        'tolerance [m]': worst.tolerance,
        'estimated cost [us]': cost,
        'budget [us]': budget,
    }
    level = WARN
    text = f'no model is within the budget; allow {cost:.3g} us for {chosen}'
    if not 0.0 < budget < cost:
        text = f'{worst.tree.name}: no model is within the tolerance; allow {error:.2g} m for '
        text += worst.choice.name
        if error <= worst.tolerance:
            level = OK
            text = simulator.model
    return Status('model', level, text, values)
