# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Whatever is sent as wind: no error, no pose that is not finite, unit quaternions."""

import math
import random

import numpy as np
import pytest

from tree_sway_ros.core.simulator.settings import Settings
from tree_sway_ros.core.wind.averaging import WindAverage
from tree_sway_ros.core.wind.convention import WindConvention
from tree_sway_ros.core.wind.intake import WindIntake
from tree_sway_ros.files.trees.source import open_scene
from tree_sway_ros.files.wind.nmea import parse_nmea
from tree_sway_ros.files.wind.sonic_ascii import parse_sonic
from tree_sway_ros.ros.timing.stepping import Stepper

ODD = (math.nan, math.inf, -math.inf, 0.0, -0.0, 5e-324, 1e300, -1e300, 999.99, 327.68, 40.0, 1e6)
STAMPS = (0, -1, 1, 2**31 * 10**9, -(2**31) * 10**9, 10**9)
PERIOD = 16_666_667
LINES = (
    "$WIMWV,084.0,T,10.4,N,A*04",
    "$WIMWD,270.0,T,268.0,M,12.4,N,6.4,M*5C",
    "$IIVWR,75,R,1.0,N,0.51,M,1.85,K*6C",
    "Q,229,002.74,M,00,16",
    "S 00.65 S2 00.65 D 245 U 00.58 V 00.27 W 00.09 T 22.6",
)


def numbers(rng):
    return tuple(
        rng.choice(ODD) if rng.random() < 0.3 else rng.gauss(0.0, rng.choice((1.0, 8.0, 100.0)))
        for _ in range(3)
    )


def stamp(rng, now):
    kind = rng.random()
    if kind < 0.6:
        return now - rng.randrange(50_000_000)
    return rng.choice(STAMPS) if kind < 0.8 else now + rng.randrange(-(10**11), 10**11)


def fuzz(n, seed):
    """Send n samples to a tree; return how many were good."""
    rng, now, good = random.Random(seed), 10**18, 0
    source = open_scene("benjamina")
    simulator = source.simulator(Settings())
    stepper = Stepper(simulator, WindAverage, PERIOD)
    stepper.restart(now)
    gate, own = WindIntake(WindConvention()), WindIntake.of_velocities()
    for k in range(n):
        first = gate.offer(stamp(rng, now), numbers(rng), now)
        second = first and own.offer(first.time, tuple(first.velocity.tolist()), now)
        if second:
            good += 1
            stepper.add_wind(*second)
        if k % 10 == 0:
            now += PERIOD
            stepper.advance(now, 1, 0.02)
        if k % 100 == 0:
            poses = simulator.place()
            assert np.isfinite(poses).all()
            assert np.abs(np.linalg.norm(poses[:, 3:], axis=1) - 1.0).max() < 1e-6
    return good


def fuzz_lines(n, seed):
    """Read n damaged lines; return how many of them said a wind."""
    rng, good = random.Random(seed), 0
    for _ in range(n):
        line = list(rng.choice(LINES))
        for _ in range(rng.randrange(4)):
            place = rng.randrange(len(line)) if line else 0
            line[place : place + rng.randrange(3)] = chr(rng.choice((rng.randrange(128), 0x20AC)))
        text = "".join(line)
        said = parse_nmea(text, 0.0, 0.0, need_checksum=False) or parse_sonic(
            text, 0.0, need_checksum=False
        )
        if said is not None and said.velocity is not None:
            good += 1
            assert all(math.isfinite(each) for each in said.velocity)
    return good


def test_any_samples():
    assert fuzz(20_000, 1) > 200  # good enough to go on


def test_any_lines():
    assert fuzz_lines(20_000, 2) > 1000


@pytest.mark.long
def test_ten_million_samples():
    assert fuzz(10_000_000, 3) > 50_000


@pytest.mark.long
def test_a_million_lines():
    assert fuzz_lines(1_000_000, 4) > 50_000
