# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Frequency and damping of a tree that was pulled and released.

A free decay is a sum of damped exponentials, the same ones in every channel. The matrix pencil
finds them all at once, so that a second mode, the other axis or a shifted rest position do not
bias the first (Hua & Sarkar, 1990). The standard errors come from the curvature of the
least-squares fit and from the change of the result during the decay, for the damping of a real
tree depends on its amplitude.

Symbols: s = -zeta w + i w sqrt(1 - zeta^2) pole in [1/s], w circular frequency, zeta damping
ratio.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import fft, linalg, signal

from tree_sway.core.arrays import Floats
from tree_sway.errors import FormatError

Complex = NDArray[np.complex128]

_SAMPLES_PER_CYCLE = 16
_MAX_CYCLES = 30.0
_MAX_ORDER = 12
_MIN_CYCLES = 3.0
_FAINT = 0.05
_LATER_STARTS = (0.5, 1.0, 1.5)


@dataclass(frozen=True)
class FreeDecay:
    """
    Free decay: undamped frequency [Hz], damping ratio including the air's, and their errors.

    The errors are standard errors; the fit is over a number of cycles. ``explained`` is the share
    of the energy within the fit that decaying modes explain; ``quiet`` the largest amplitude
    around the frequency before and after the decay, over the largest of all; ``speed`` that
    amplitude times the frequency, per second.
    """

    frequency: float
    damping_ratio: float
    frequency_error: float
    damping_error: float
    cycles: float
    explained: float
    quiet: float
    speed: float


@dataclass(frozen=True)
class _Fit:
    """Dominant pole of a stretch of motion, its standard error, and the energy explained [-]."""

    pole: complex
    error: float
    explained: float


def free_decay(motion: Floats, dt: float, rough: float) -> FreeDecay:
    """
    Fit the decay of a pull-and-release record: the strongest mode near a frequency.

    Parameters
    ----------
    motion
        Motion at equal steps without its mean and drift, one column per axis, (n, c).
    dt
        Time step in [s].
    rough
        Frequency near which the mode is in [Hz].

    Raises
    ------
    FormatError
        Fewer than three cycles, or no motion that decays.

    """
    slow, envelope = _filtered(motion, dt, rough)
    stride = max(1, int(1.0 / (rough * dt * _SAMPLES_PER_CYCLE)))
    cycle = 1.0 / (rough * dt)
    peak = int(np.argmax(envelope))
    first = peak + round(0.5 * cycle)
    available = (len(motion) - first) / cycle
    if available < _MIN_CYCLES:
        what = f'{max(available, 0.0):.1f} cycles of {rough:.3g} Hz after the largest swing'
        cure = 'record 5 cycles after the release, better 10, or name the band of the sway'
        raise FormatError(what, cure=cure)
    # A window that ends where 5 % are left; its length follows from a first fit.
    cycles = min(8.0, available)
    for _ in range(3):
        end = first + round(cycles * cycle)
        fit = _pencil(slow[first:end:stride], stride * dt, rough)
        decay_rate = max(-fit.pole.real, 1e-9)
        left = 3.0 * abs(fit.pole) / (2.0 * np.pi * decay_rate)
        cycles = float(np.clip(left, _MIN_CYCLES, min(available, _MAX_CYCLES)))
    last = first + round(cycles * cycle)
    poles = [fit.pole]
    for later in _LATER_STARTS:
        begin = first + round(later * cycle)
        if last - begin >= _MIN_CYCLES * cycle:
            later_fit = _pencil(slow[begin:last:stride], stride * dt, rough)
            poles.append(later_fit.pole)
    circular = abs(fit.pole)
    frequency_spread = np.std([abs(pole) for pole in poles])
    damping_spread = np.std([-pole.real / abs(pole) for pole in poles])
    frequency_error = np.hypot(fit.error, frequency_spread) / (2.0 * np.pi)
    damping_error = np.hypot(fit.error / circular, damping_spread)
    margin = round(2.5 * cycle)
    before = envelope[: max(peak - margin, 0)]
    after = envelope[last + margin :]
    loudest = max(before.max(initial=0.0), after.max(initial=0.0))
    variance = slow[first:last].var(axis=0).sum()
    share = float(variance / motion[first:last].var(axis=0).sum())
    return FreeDecay(
        frequency=circular / (2.0 * np.pi),
        damping_ratio=-fit.pole.real / circular,
        frequency_error=float(frequency_error),
        damping_error=float(damping_error),
        cycles=cycles,
        explained=fit.explained * min(share, 1.0),
        quiet=float(loudest / envelope[peak]),
        speed=float(envelope[peak]) * rough,
    )


def _filtered(motion: Floats, dt: float, rough: float) -> tuple[Floats, Floats]:
    """Motion (n, c) below three times a frequency, and the envelope (n,) around it."""
    nyquist = 0.5 / dt
    slow = motion
    if 3.0 * rough < 0.8 * nyquist:
        low = signal.butter(4, 3.0 * rough / nyquist, output='sos')
        slow = signal.sosfiltfilt(low, motion, axis=0)
    highest = min(1.7, 0.9 * nyquist / rough)
    edges = np.array([0.5, highest]) * rough / nyquist
    around = signal.butter(2, edges, 'bandpass', output='sos')
    band = signal.sosfiltfilt(around, motion, axis=0)
    # The transform is periodic: zeros after the end separate it from a large start.
    n_zeros = round(10.0 / (rough * dt))
    padded = fft.next_fast_len(len(motion) + n_zeros)
    analytic = signal.hilbert(band, padded, axis=0)[: len(motion)]
    squares = np.abs(analytic) ** 2
    envelope: Floats = np.sqrt(squares.sum(axis=1))
    return slow, envelope


def _pencil(motion: Floats, dt: float, rough: float) -> _Fit:
    """Matrix pencil of all channels at once; the pole with the most energy near a frequency."""
    centred = motion - motion.mean(axis=0)
    factors = _factors_per_step(centred)
    exponents = np.arange(len(motion))[:, None]
    powers: Complex = factors[None, :] ** exponents
    amplitudes = linalg.lstsq(powers, centred.astype(np.complex128))[0]
    rest = centred - (powers @ amplitudes).real
    poles = np.asarray(np.log(factors) / dt, dtype=np.complex128)
    energy = _energy(powers, 0) * _energy(amplitudes, 1)
    is_near = _are_near(poles, rough, energy)
    if not is_near.any():
        cure = 'check that it is a pull-and-release record, or name the band the sway is in'
        raise FormatError(f'no motion that decays near {rough:.3g} Hz', cure=cure)
    best = int(np.argmax(np.where(is_near, energy, -1.0)))
    left_out = float((rest**2).sum() / (centred**2).sum())
    error = _standard_error(powers[:, best], amplitudes[best], dt, rest)
    return _Fit(complex(poles[best]), error, 1.0 - left_out)


def _factors_per_step(motion: Floats) -> Complex:
    """Factors (k,) by which the exponentials of all channels (n, c) change in a step."""
    n = len(motion)
    span = n // 3
    blocks = [linalg.hankel(x[: n - span], x[n - span - 1 :]) for x in motion.T]
    _, weights, right = linalg.svd(np.vstack(blocks), full_matrices=False)
    # Singular values of noise lie around their median (Gavish & Donoho, 2014).
    floor = max(2.858 * float(np.median(weights)), 1e-7 * float(weights[0]))
    n_above = (weights > floor).sum()
    order = int(np.clip(n_above, 3, min(_MAX_ORDER, span - 1)))
    basis = right[:order].T
    shift = linalg.lstsq(basis[:-1], basis[1:])[0]
    factors: Complex = linalg.eigvals(shift)
    size = np.abs(factors)
    return factors[(size > 1e-3) & (size < 1.05)]


def _are_near(poles: Complex, rough: float, energy: Floats) -> NDArray[np.bool_]:
    """Whether poles (k,) decay near a frequency [Hz], with more than a faint energy."""
    decay = (poles.imag > 0.0) & (poles.real < 0.0)
    ratio = np.abs(poles) / (2.0 * np.pi * rough)
    are_near = np.abs(np.log(ratio + 1e-300)) < 0.35
    # Relative to the sway, not to a drift of the rest position, which slow poles fit.
    swings = poles.imag > np.pi * rough
    largest = energy[swings].max(initial=0.0)
    return np.asarray(decay & are_near & (energy > _FAINT * largest))


def _energy(motions: Complex, axis: int) -> Floats:
    """Sum of squares of complex motions over an axis."""
    return np.asarray((np.abs(motions) ** 2).sum(axis=axis))


def _standard_error(decay: Complex, amplitude: Complex, dt: float, rest: Floats) -> float:
    """
    Return the standard error of a pole's real and imaginary part in [1/s].

    A least-squares pole is as uncertain as the part of ``t e^(s t)`` that no amplitude of ``e^(s
    t)`` can replace.
    """
    moved = dt * np.arange(len(decay)) * decay
    moved -= decay * np.vdot(decay, moved) / np.vdot(decay, decay)
    information = 2.0 * float(_energy(moved, 0)) * float(_energy(amplitude, 0))
    return float(np.sqrt((rest**2).mean() / information))
