# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
From a record of a swaying tree to its natural frequency and damping ratio.

A record is a pull-and-release: one large swing that decays, with little motion before and after.
It is scale-free: displacement, tilt and acceleration give the same result.
"""

from __future__ import annotations

from contextlib import suppress

import numpy as np
from numpy.typing import ArrayLike
from scipy import signal

from tree_sway.core.arrays import Floats
from tree_sway.errors import FormatError, ParameterError
from tree_sway.identification.free_decay import free_decay, FreeDecay
from tree_sway.identification.spectral_peaks import Band, spectral_peaks

_MIN_SAMPLES = 16
_LARGEST = 1e100
_UNSURE = (0.03, 0.25)
_CLEAR = 0.5
"""Share of the largest prominence, of logarithms, from which on a peak is clear."""
_LEAST_CLEAR = 4.0
_EXPLAINED = 0.6
_QUIET = 0.5
_STRONG = 0.03
_FAST = 0.15


def estimate_sway(time: ArrayLike, motion: ArrayLike, band: Band = None) -> FreeDecay:
    """
    Find frequency and damping of the slowest sway in a record.

    Parameters
    ----------
    time
        Time of each sample in [s], rising, (n,).
    motion
        Displacement, tilt or acceleration, one column per axis, all of one unit, (n,) or (n, c).
    band
        Lowest and highest frequency to consider in [Hz]; all if None.

    Returns
    -------
    FreeDecay
        Frequency and damping ratio with their standard errors.

    Raises
    ------
    FormatError
        A record that is too short, too coarse, not finite, not rising in time, or without a sway.
    ParameterError
        An empty band.

    """
    if band is not None and not 0.0 < band[0] < band[1] < np.inf:
        raise ParameterError(
            f'band {band[0]:g} to {band[1]:g} Hz', cure='give two rising frequencies above 0'
        )
    even, dt, gap = _even(*_checked(time, motion))
    decay = _release(even, dt, gap, band)
    if not _is_release(decay):
        peak = _clearest(even, dt, band)
        told = f'; it is clearest at {peak:.3g} Hz' if peak else ''
        raise FormatError(
            f'the motion does not decay from one swing{told}',
            cure='record a pull and release on a calm day; of a tree in wind, give that frequency '
            'yourself if it is the sway, and not the damping',
        )
    _refuse_lost(decay)
    return decay


def _clearest(even: Floats, dt: float, band: tuple[float, float] | None) -> float:
    """
    Return the lowest frequency [Hz] that stands out from those beside it; 0 without one.

    As it is compared on a scale of logarithms, it is the same of a displacement and of the
    acceleration, whose noise is largest at other ends of the spectrum.
    """
    frequency, power = signal.welch(even, 1.0 / dt, nperseg=min(len(even) // 4, 4096), axis=0)
    lowest, highest = band or (0.0, np.inf)
    is_wanted = (frequency > lowest) & (frequency < highest)
    levels = np.log(power.sum(axis=1)[is_wanted] + np.finfo(float).tiny)
    peaks, known = signal.find_peaks(levels, prominence=0.0)
    if not len(peaks):
        return 0.0
    is_clear = known['prominences'] >= _CLEAR * known['prominences'].max()
    return float(frequency[is_wanted][peaks[is_clear][0]])


def _is_release(decay: FreeDecay) -> bool:
    """Wind makes a tree swing repeatedly; around a release the motion is a tenth of the swing."""
    return decay.explained > _EXPLAINED and decay.quiet < _QUIET


def _refuse_lost(decay: FreeDecay) -> None:
    """Refuse a swing that soon falls below the motion by wind: its damping is uncertain."""
    f = decay.frequency
    z = decay.damping_ratio
    clear = np.log(1.0 / max(decay.quiet, 1e-9)) / (2.0 * np.pi * z)
    if decay.frequency_error > _UNSURE[0] * f or decay.damping_error > _UNSURE[1] * z:
        what = f'{f:.3g} +- {decay.frequency_error:.2g} Hz'
        what = f'{what}, damping {z:.2g} +- {decay.damping_error:.2g}'
    elif clear < _LEAST_CLEAR:
        what = f'the swing falls below other motion after {clear:.1f} cycles, at damping {z:.2g}'
    else:
        return
    raise FormatError(
        f'{what}: too much other motion beside the swing',
        cure='pull farther or on a calmer day, or give frequency and damping yourself',
    )


def _checked(time: ArrayLike, motion: ArrayLike) -> tuple[Floats, Floats]:
    """Check and return arrays (n,) and (n, c)."""
    t = np.asarray(time, dtype=np.float64)
    x = np.asarray(motion, dtype=np.float64)
    x = x[:, None] if x.ndim == 1 else x
    if t.ndim != 1 or x.ndim != 2 or len(t) != len(x):
        raise FormatError(
            f'times of shape {t.shape}, motion of shape {x.shape}', cure='give (n,) and (n, c)'
        )
    if len(t) < _MIN_SAMPLES:
        raise FormatError(f'{len(t)} samples', cure=f'record {_MIN_SAMPLES} at the very least')
    # Far enough from overflow that sums of squares are too.
    for bad in np.flatnonzero(~(np.abs(np.column_stack([t, x])) < _LARGEST).all(axis=1))[:1]:
        what = 'not a finite number, or an implausible one'
        raise FormatError(what, where=f'sample {bad}', cure='remove that sample')
    for bad in np.flatnonzero(np.diff(t) <= 0.0)[:1]:
        what = f'time {t[bad + 1]:g} s after {t[bad]:g} s'
        cure = 'put the samples in the order of time, each time once'
        raise FormatError(what, where=f'sample {bad + 1}', cure=cure)
    if not (np.ptp(x, axis=0) > 1e-12 * np.abs(x).max(axis=0)).any():
        raise FormatError('nothing moves', cure='check the sensor and the column')
    return t, x


def _even(time: Floats, motion: Floats) -> tuple[Floats, float, float]:
    """Motion at equal steps without its mean and drift, the step and the longest gap in [s]."""
    steps = np.diff(time)
    dt = float(np.median(steps))
    if time[-1] - time[0] > 4.0 * len(time) * dt:
        what = f'gaps of up to {steps.max():.3g} s between samples {dt:.3g} s apart'
        raise FormatError(what, cure='give one record without the gaps')
    grid = np.arange(time[0], time[-1] + 0.5 * dt, dt)
    even = np.stack([np.interp(grid, time, x) for x in motion.T], axis=1)
    return signal.detrend(even, axis=0), dt, float(steps.max())


def _release(motion: Floats, dt: float, gap: float, band: Band) -> FreeDecay:
    """Slowest clear decay at strong peaks of the velocity's spectrum, not hidden by a step."""
    padded = 4 * len(motion)
    frequency = np.fft.rfftfreq(padded, dt).astype(np.float64)
    power = (np.abs(np.fft.rfft(motion, padded, axis=0)) ** 2).sum(axis=1) * frequency**2
    peaks, level = spectral_peaks(frequency, power, len(motion) * dt, band)
    strong = level > _STRONG * level.max()
    # Where the strongest peak has too few cycles, a weaker one is a different mode, or noise.
    found = [_decay_near(motion, dt, gap, float(peaks[np.argmax(level)]))]
    for rough in peaks[strong & (level < level.max())].tolist():
        with suppress(FormatError):
            found.append(_decay_near(motion, dt, gap, rough))
    # Beside the sway, a step of the rest position has slow parts that decay too; they move little
    # per second.
    fastest = max(found, key=lambda decay: decay.speed)
    fast = [one for one in found if one.speed > _FAST * fastest.speed]
    fast.sort(key=lambda decay: decay.frequency)
    clearest = max(fast, key=lambda decay: decay.explained)
    return next(filter(_is_release, fast), clearest) if fastest.quiet < _QUIET else fastest


def _decay_near(motion: Floats, dt: float, gap: float, rough: float) -> FreeDecay:
    """Fit the decay near a peak [Hz], if samples and gaps [s] resolve it."""
    if gap * rough > 0.25:
        what = f'{gap:.3g} s between samples, for a sway of {rough:.3g} Hz'
        raise FormatError(what, cure='record at least four samples per cycle, without gaps')
    return free_decay(motion, dt, rough)
