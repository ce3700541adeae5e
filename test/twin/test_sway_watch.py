# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Another frequency or another mode is seen within two blocks; other winds are no change."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import lfilter

from tree_sway.core.arrays import Floats
from tree_sway.twin.sensor_spectrum import SensorSpectrum
from tree_sway.twin.sway_watch import BLOCK, SwayWatch

DT, NOISE = 0.1, 0.004
N_STEPS = round(BLOCK / DT) + 1
"""Steps of a block."""
WINDS = (4.0, 7.0, 3.0, 5.0, 8.0, 4.0, 6.0, 3.5, 5.0, 7.5, 5.0)


def swayed(frequency: float, wind: float, rng: np.random.Generator) -> Floats:
    """Return the sway of a block by white forces, whose damping and size grow with the wind."""
    size, damping = np.exp(-2.0 * np.pi * frequency * 0.01 * wind * DT), 2.0 * np.pi * frequency
    denominator = [1.0, -2.0 * size * np.cos(damping * DT), size * size]
    forces = 0.001 * wind**2 * rng.normal(size=(N_STEPS, 3))
    return np.asarray(lfilter([1.0], denominator, forces, axis=0))


def watched(
    frequencies: list[float], seed: int, share: float = 1.0, limb: float = 3.0
) -> SwayWatch:
    """
    Watch blocks of these frequencies [Hz], of a share of the sway, measured with noise.

    From the sixth block on, a limb, whose own mode is seen little, has another frequency [Hz].
    """
    rng = np.random.default_rng(seed)
    spectrum = SensorSpectrum(1.0, DT, 1)
    watch = SwayWatch(spectrum, 1.0)
    rows, native = spectrum._series.reshape(-1, 5), spectrum.native
    blown, count = 0.0, 0
    for k, (frequency, wind) in enumerate(zip(frequencies, WINDS, strict=False)):
        of_limb = 0.2 * swayed(3.0 if k < 5 else limb, wind, rng)
        sway = swayed(frequency, wind, rng) + of_limb
        motion = share * sway + NOISE * rng.normal(size=(N_STEPS, 3))
        for each in motion:
            rows[native.filled % len(rows), [0, 1, 3, 4]] = *each[:2], *each[:2]
            native.filled += 1
            n_noted = spectrum.count
            assert spectrum.advance()
            if spectrum.count > n_noted:
                spectrum.note_noise(NOISE, NOISE)
            blown, count = blown + wind, count + 1
            watch.advance((blown, 0.0, count))
    return watch


def has_changed(watch: SwayWatch) -> bool:
    return watch.change is not None and watch.change.is_change


@pytest.mark.parametrize('seed', range(4))
def test_wind_is_no_change(seed: int) -> None:
    watch = watched([1.0] * len(WINDS), seed)
    assert watch.change is not None
    assert not has_changed(watch)
    assert 'as before' in str(watch.change)


@pytest.mark.parametrize('ratio', [0.88, 1.12])
def test_another_frequency_is_seen_and_stays_said(ratio: float) -> None:
    for count in (7, 9):
        watch = watched([1.0] * 5 + [ratio] * (count - 5), seed=7)
        assert has_changed(watch)
        assert watch.change is not None
        assert watch.change.ratio == pytest.approx(ratio, abs=0.05)
        assert 'sways differently' in str(watch.change)


def test_leaves_that_have_dried_are_no_change_any_more() -> None:
    frequencies = [1.0] * 5 + [0.9] * 2
    assert has_changed(watched(frequencies, seed=7))
    dried = watched([*frequencies, 1.0, 1.0, 1.0], seed=7)
    assert not has_changed(dried)
    assert 'as before' in str(dried.change)


def test_leaves_that_dry_slowly_are_no_change_any_more() -> None:
    frequencies = [1.0] * 5 + [0.85, 0.85, 0.91, 0.91]
    wet, dried = watched(frequencies, seed=7), watched([*frequencies, 0.96, 0.96], seed=7)
    assert wet.change is not None
    assert dried.change is not None
    assert wet.change.of_middle > 1.0 > dried.change.of_middle


def test_another_mode_of_a_limb_is_seen_in_its_band() -> None:
    watch = watched([1.0] * 8, seed=9, limb=3.6)
    assert watch.change is not None
    assert watch.change.ratio == pytest.approx(1.0, abs=0.03)
    band = watch.change.changed_band
    assert band is not None
    assert 2.5 < band.low < band.high < 4.5
    assert 'times the power' in str(watch.change)


def test_noise_alone_tells_nothing() -> None:
    watch = watched([1.0] * 6, seed=8, share=0.0)
    assert watch.change is None
