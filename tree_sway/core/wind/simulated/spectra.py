# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Spectra of turbulence: how the variance of the wind at a point is shared by frequencies.

A new model of the wind is one function here and its entry in `SPECTRA`: the simulated anemometer,
its node and the command line offer what is there.
"""

from __future__ import annotations

from collections.abc import Callable
from types import MappingProxyType
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats


class Spectrum(NamedTuple):
    """
    A model of turbulence: the spectrum of a component, and integral scales of u, v, w, (3,).

    The spectrum is a function as `kaimal_spectrum`; the scales are over the turbulence scale
    Lambda1 of IEC 61400-1.
    """

    of_component: Callable[..., Floats]
    scales: tuple[float, float, float]


def kaimal_spectrum(
    frequency: ArrayLike, mean_speed: float, deviation: float, scale: float,
    *, across: bool = False,
) -> Floats:  # fmt: skip
    """
    Kaimal spectrum of one component, one-sided.

    Parameters
    ----------
    frequency
        Frequencies in [Hz], (n,).
    mean_speed
        Mean wind speed in [m/s].
    deviation
        Standard deviation of the component in [m/s].
    scale
        Its integral scale in [m].
    across
        True for v and w, which have the same shape as u.

    Returns
    -------
    Floats
        Power spectral density in [m^2/s^2/Hz], (n,); its integral from 0 is ``deviation**2``.
        Source: Kaimal et al. (1972) as in IEC 61400-1:2005, annex B, equation B.14.

    """
    time = scale / mean_speed
    x = np.asarray(frequency, dtype=np.float64) * time
    return deviation**2 * 4.0 * time / (1.0 + 6.0 * x) ** (5 / 3)


def von_karman_spectrum(
    frequency: ArrayLike, mean_speed: float, deviation: float, scale: float,
    *, across: bool = False,
) -> Floats:  # fmt: skip
    """
    Von Karman spectrum of one component, one-sided; arguments as of `kaimal_spectrum`.

    Its integral from 0 is ``deviation**2`` to 2e-4, for the rounding of the constants. Source: von
    Karman (1948) as in ESDU 85020.
    """
    time = scale / mean_speed
    x2 = (np.asarray(frequency, dtype=np.float64) * time) ** 2
    if across:
        shape = (1.0 + 755.2 * x2) / (1.0 + 283.2 * x2) ** (11 / 6)
    else:
        shape = (1.0 + 70.8 * x2) ** (-5 / 6)
    return deviation**2 * 4.0 * time * shape


_KAIMAL_SCALES = np.array([8.1, 2.7, 0.66])
"""Integral scales of u, v, w over Lambda1, by IEC 61400-1."""

# Von Karman scales that share the inertial subrange of Kaimal, and so its rate of dissipation. For
# u this is IEC's own 3.5 Lambda1; for v and w the standard's 4/3 S_u of local isotropy is kept.
_SUBRANGE_KAIMAL = 4.0 / 6.0 ** (5 / 3)
_SUBRANGE_VON_KARMAN = np.array([4.0 / 70.8 ** (5 / 6)] + [4.0 * 755.2 / 283.2 ** (11 / 6)] * 2)
_VON_KARMAN_SCALES = _KAIMAL_SCALES * (_SUBRANGE_VON_KARMAN / _SUBRANGE_KAIMAL) ** 1.5

SPECTRA = MappingProxyType(
    {
        'kaimal': Spectrum(kaimal_spectrum, tuple(_KAIMAL_SCALES.tolist())),
        'von_karman': Spectrum(von_karman_spectrum, tuple(_VON_KARMAN_SCALES.tolist())),
    }
)
"""Models of turbulence by their names."""
