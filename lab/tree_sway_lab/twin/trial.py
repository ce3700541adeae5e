# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A tree with sensors against the true one: error, roughness, coverage of its band."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
import time
from typing import Any

import numpy as np
from scipy.signal import lfilter
from scipy.spatial.transform import Rotation

from tree_sway.core.arrays import Floats
from tree_sway.core.run import SwaySimulator
from tree_sway.core.setup import prepare
from tree_sway.core.species import Species
from tree_sway.core.tree import tips_of_poses, Tree
from tree_sway.twin import ObservedTree, sensor_reports
from tree_sway_lab.twin.linear_filter import linear_filter
from tree_sway_lab.twin.sensor_faults import FAULTS, FIRST, LIVE, WAY
from tree_sway_lab.twin.simulated_sensor import SensedMotion, SimulatedSensor
from tree_sway_lab.twin.sway_comparison import compare_sway
from tree_sway_lab.twin.true_tree import Circumstances, DT, pose_at, TrueMotion

FAULTY = SimulatedSensor(
    rate=25.0,
    jitter=0.01,
    lost=0.05,
    bias=np.deg2rad(0.5),
    tilt=np.deg2rad(0.5),
    askew=Rotation.from_euler('xyz', [3.0, -3.0, 2.6], degrees=True),
)
"""
A sensor of 25 Hz that loses 5 %, with stamps that err by 10 ms, biased by 0.5 deg/s and 0.5
degrees, the axes of its angular rate 5 degrees askew to those of its acceleration.
"""

_LATEST = 0.15
"""Faulty sensors have stamps that are late by up to this time [s], each by its own."""

_TRUSTED = 0.45
"""Share of a record from which on it is scored: before, mountings are found."""


@dataclass(frozen=True)
class Score:
    """
    How far a tree is from the true one.

    Parameters
    ----------
    error
        Dynamic error of all tips over their dynamic motion [-].
    roughness
        Second difference of the tips over that of the true ones [-].
    stem
        Correlation of the stem's tip with the true one, the smaller of both axes [-].
    held
        Share of the time that the band of 80 % holds the tips [-]; not a number without a band.
    cost, worst
        Median and 99th percentile of the processor's time of a step in [us], sensors and all,
        while scored; not what gains and fits take in a thread beside the steps.
    beside
        CPU time of these in [us] per step, over the whole record.
    at
        Correlation of the place of the first sensor with the true one, the smaller of both axes
        [-]; not a number without a sensor.
    found, told
        Times in [s] at which the first sensor was in use first, and out of use first after that.
    notes
        Notes of the sensors.
    bands
        Power of the tips over that of the true ones in each of `BANDS` [-].

    """

    error: float
    roughness: float
    stem: float
    held: float
    cost: float
    worst: float
    beside: float = 0.0
    at: float = np.nan
    found: float = np.nan
    told: float = np.nan
    notes: tuple[str, ...] = ()
    bands: tuple[float, ...] = ()


def mean_score(scores: Sequence[Score]) -> Score:
    """Return the mean of scores; the notes are those of all."""
    names = [each.name for each in fields(Score) if each.name not in ('notes', 'bands')]
    means = {name: float(np.mean([getattr(each, name) for each in scores])) for name in names}
    bands = np.exp(np.mean([np.log(each.bands) for each in scores], axis=0))
    notes = tuple(note for each in scores for note in each.notes)
    return Score(**means, notes=notes, bands=tuple(np.atleast_1d(bands).tolist()))


def plain_score(sim: SwaySimulator, true: TrueMotion) -> Score:
    """Score a simulator as it is without sensors."""
    tips, spent = swayed(sim, true.wind)
    error, roughness, stem = _compared(tips, true.tips)
    first = round(_TRUSTED * len(tips))
    found, wanted = (each[first:].reshape(len(tips) - first, -1) for each in (tips, true.tips))
    bands = compare_sway(found, wanted, 1.0 / DT, float(sim.frequencies(1)[0])).bands
    return Score(error, roughness, stem, np.nan, *_costs(spent), bands=bands)


def swayed(sim: SwaySimulator, winds: Floats) -> tuple[Floats, Floats]:
    """Tips of a simulator (n, b, 3) in the winds of its steps, and the time of each [ns], (n,)."""
    block = np.empty((sim.tree.n_segments, 7))
    tips, spent = np.empty((len(winds), sim.tree.n_branches, 3)), np.empty(len(winds))
    for k, each in enumerate(winds):
        began = time.thread_time_ns()
        sim.step(each, DT)
        spent[k] = time.thread_time_ns() - began
        tips[k] = tips_of_poses(sim.tree, sim.place(block))
    return tips, spent


def _costs(spent: Floats) -> tuple[float, float]:
    """Median and 99th percentile, in [us], of times [ns] of the later steps of a record."""
    later = 1e-3 * spent[round(_TRUSTED * len(spent)) :]
    return float(np.median(later)), float(np.quantile(later, 0.99))


def squared_score(true: TrueMotion, frequency: float, like: Floats | None = None) -> Score:
    """
    Score the square of the wind, low-passed at a frequency [Hz], as a model of the motion.

    It gets the gains by which each tip follows it best along each axis: from the truth itself, or
    from the tips (n, b, 3) of another tree in the same wind.
    """
    squared = np.linalg.norm(true.wind, axis=1, keepdims=True) * true.wind
    keep = float(np.exp(-2.0 * np.pi * frequency * DT))
    passed = lfilter([1.0 - keep], [1.0, -keep], squared, axis=0)
    inputs = np.column_stack([np.ones(len(passed)), passed])
    flat = (true.tips if like is None else like).reshape(len(passed), -1)
    first = round(_TRUSTED * len(passed))
    gains = np.linalg.lstsq(inputs[first:], flat[first:], rcond=None)[0]
    tips = (inputs @ gains).reshape(true.tips.shape)
    error, roughness, stem = _compared(tips, true.tips)
    return Score(error, roughness, stem, np.nan, 0.0, 0.0)


def linear_score(true: TrueMotion, places: Sequence[str]) -> Score:
    """Score a linear filter that is fitted to the true tips by what sensors at places measure."""
    tips, wanted = linear_filter(true, places)
    error, _, stem = _compared(tips, wanted)
    return Score(error, np.nan, stem, np.nan, np.nan, np.nan)


def twin_score(
    tree: Tree,
    species: Species,
    true: TrueMotion,
    places: Sequence[str],
    *,
    in_leaf: bool,
    seed: int = 7,
    faulty: bool = False,
    has_band: bool = True,
    upwind: float = 0.0,
    known: Circumstances | None = None,
    fault: str = 'none',
    **changes: Any,
) -> Score:
    """
    Score a tree that sensors correct, told how far upwind the anemometer is [m].

    Further settings are those of `ObservedTree`. With what is ``known`` of
    the true tree, its wood and damping are the model's.
    """
    damping_ratio = None
    if known is not None:
        usual = prepare(tree, species, model=0, in_leaf=in_leaf).damping_ratio
        damping_ratio = min(known.damping * usual, 1.0)
        species = replace(species, modulus=known.wood * species.modulus)
    twin = ObservedTree(
        tree,
        species,
        in_leaf=in_leaf,
        learns=known is None,
        damping_ratio=damping_ratio,
        at={each: each for each in places},
        has_band=has_band,
        upwind=upwind,
        **changes,
    )
    rng = np.random.default_rng(seed)
    live: list[tuple[str, SensedMotion, Floats]] = []
    for name in places:
        mount = Rotation.random(rng=rng)
        sensor = SimulatedSensor(mount=mount)
        if faulty:
            sensor = replace(FAULTY, mount=mount, lateness=rng.uniform(0.0, _LATEST))
        motion = sensor.measured(true.poses[name], DT, rng)
        came = motion.time + WAY
        if name == places[0] or not fault.startswith(FIRST):
            motion = FAULTS[fault](motion, rng)
        if fault.startswith(LIVE):
            live.append((name, motion, came))
        else:
            twin.replay(name, motion.time, acceleration=motion.acceleration, rate=motion.rate)
    block = np.empty((tree.n_segments, 7))
    tips = np.empty_like(true.tips)
    bands = np.full((len(tips), 2, *tips.shape[1:]), np.nan)
    spent = np.empty(len(tips))
    first = next(iter(places), '')
    place, in_use = np.zeros((len(tips), 3)), np.zeros(len(tips), dtype=np.bool_)
    both = time.process_time_ns() - time.thread_time_ns()
    for k, each in enumerate(true.wind):
        for name, motion, came in live:
            _offer_new(twin, name, motion, came, k)
        began = time.thread_time_ns()
        twin.step(each, DT)
        spent[k] = time.thread_time_ns() - began
        tips[k] = tips_of_poses(tree, twin.place(block))
        if first:
            in_use[k] = twin.observer.tracks[0].in_use
            place[k] = pose_at(tree, block, twin.sensors[first].place)[:3]
        if has_band:
            bands[k] = twin.band()
    beside = 1e-3 * (time.process_time_ns() - time.thread_time_ns() - both) / len(tips)
    error, roughness, stem = _compared(tips, true.tips)
    notes = [*twin.problems]
    at, found, told = np.nan, np.nan, np.nan
    if first:
        begin = round(_TRUSTED * len(tips))
        at = _least_r(place[begin:], true.poses[first][begin:, :3])
        counts = twin.sensors[first].counts
        notes += [each for report in sensor_reports(twin) for each in report.notes]
        notes += [f'{counts.refused} samples refused'] if counts.refused else []
        found = float(np.argmax(in_use)) * DT if in_use.any() else np.inf
        ended = ~in_use & np.logical_or.accumulate(in_use)
        told = float(np.argmax(ended)) * DT if ended.any() else np.nan
    if twin.late_wind.delay:
        notes.append(f'gusts {twin.late_wind.delay:.1f} s late')
    if (fit := twin.observer.fit) is not None:
        notes.append(
            f'stiffness {fit.stiffness:.3f}, damping {fit.damping:.2f}, drag {fit.drag:.2f}'
        )
    held = _held(tips, true.tips, bands) if has_band else np.nan
    return Score(
        error, roughness, stem, held, *_costs(spent), beside,
        at, found, told, tuple(notes),
    )  # fmt: skip


def _offer_new(
    twin: ObservedTree, name: str, motion: SensedMotion, came: Floats, step: int
) -> None:
    """Offer the samples of a sensor that come, (n,) in [s], before the end of a step."""
    first, last = np.searchsorted(came, [step * DT, (step + 1) * DT]).tolist()
    for k in range(first, last):
        twin.offer(name, motion.time[k], acceleration=motion.acceleration[k], rate=motion.rate[k])


def _compared(tips: Floats, true: Floats) -> tuple[float, float, float]:
    """Error, roughness and the stem's correlation of the later part of a record."""
    first = round(_TRUSTED * len(tips))
    found, wanted = tips[first:], true[first:]
    wrong = found - wanted
    wrong = wrong - wrong.mean(axis=0)
    motion = wanted - wanted.mean(axis=0)
    error = float(np.sqrt(np.square(wrong).sum() / np.square(motion).sum()))
    second = [np.square(np.diff(each, 2, axis=0)).sum() for each in (found, wanted)]
    return error, float(np.sqrt(second[0] / second[1])), _least_r(found[:, 0], wanted[:, 0])


def _least_r(found: Floats, wanted: Floats) -> float:
    """Correlation to east or north, the smaller one, of motions (n, 3)."""
    return min(float(np.corrcoef(found[:, axis], wanted[:, axis])[0, 1]) for axis in (0, 1))


def _held(tips: Floats, true: Floats, bands: Floats) -> float:
    """Share of the time that bands (n, 2, b, 3) about tips hold the true ones, east and north."""
    first = round(_TRUSTED * len(tips))
    beyond = (true - tips)[first:, :, :2]
    low, high = np.moveaxis(bands[first:, ..., :2], 1, 0)
    return float(((low <= beyond) & (beyond <= high)).mean())
