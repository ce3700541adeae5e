# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A bag with wind and motion, played through the nodes, gives the poses of ``simulate``."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip('rclpy', reason='ROS 2 is not installed')
pytest.importorskip('rosbags', reason='rosbags is not installed')
pytestmark = pytest.mark.ros

from rclpy.serialization import serialize_message  # noqa: E402, I100
from tree_sway_lab.twin.simulated_sensor import SimulatedSensor  # noqa: E402

from tree_sway.core.arrays import Floats  # noqa: E402
from tree_sway.core.scene.make import make_simulator  # noqa: E402
from tree_sway.core.species.species import species_named  # noqa: E402
from tree_sway.core.tree.tree import tips_of_poses  # noqa: E402
from tree_sway.core.wind.turbulence import simulate_turbulence  # noqa: E402
from tree_sway.files.motion.imu_bag import read_imu_bag  # noqa: E402
from tree_sway.files.recording.bag_writer import BagWriter  # noqa: E402
from tree_sway.files.wind.wind_file import read_wind  # noqa: E402
from tree_sway.growth.builtin import builtin_tree  # noqa: E402
from tree_sway.simulation.rig import PlacedMotion, simulate  # noqa: E402
from tree_sway.twin.late_wind import LateWind  # noqa: E402
from tree_sway.twin.sensor_place import place_on  # noqa: E402
from tree_sway_ros.process.topics import SEGMENT_POSES  # noqa: E402
from tree_sway_ros.wire.cdr import poses_of, stamp_of  # noqa: E402
from tree_sway_ros.wire.imu_messages import imu_message  # noqa: E402
from tree_sway_ros.wire.wind_messages import (  # noqa: E402
    WIND_CLASSES,
    wind_to_message,
    WindSample,
)

PERIOD = 16_666_667
DT, SECONDS = PERIOD * 1e-9, 34
DELAY = 0.5
"""Delay of the wind in [s]: samples are there before, also on a busy machine."""
LATE = 0.05
"""Period of the wind in [s], after which the next sample of it is known."""
START = 102_000_000_000 * PERIOD
"""End of a step of the solver in [ns]."""
TREE = builtin_tree('goldcrest')
AT = f'{TREE.branch_names[0]}:0.7'
TIP = int(TREE.branch_of_segment[int(np.argmax(TREE.end[:, 2]))])
TYPE = 'geometry_msgs/Vector3Stamped'


def write_bag(path: Path, *, motion_off: int, wind_off: int) -> None:
    """
    Write wind at 20 Hz, of which the tree feels more, and motion at 60 Hz.

    Stamps are off the ends of the solver's steps by times in [ns], but for the first of the wind.
    """
    softer = replace(species_named('goldcrest'), modulus=6.0e9)
    rng, segment = np.random.default_rng(41), place_on(TREE, AT).segment
    wind, missed = (
        simulate_turbulence(4.0, rate=60.0, duration=SECONDS, rng=rng) for _ in range(2)
    )
    wind[:, 2] = 0.0  # the node `wind` keeps the horizontal part alone
    true, poses = make_simulator(TREE, softer), np.empty((len(wind), 7))
    for k, each in enumerate(wind + 0.7 * (missed - missed.mean(axis=0))):
        true.step(each, DT)
        poses[k] = true.place()[segment]
    motion = SimulatedSensor(rate=60.0).measured(poses, DT, rng)
    epoch = START + motion_off
    with BagWriter(path) as writer:
        writer.add('/wind', 'geometry_msgs/msg/Vector3Stamped')
        writer.add('/tree/imu', 'sensor_msgs/msg/Imu')
        for k in range(0, len(wind), 3):
            stamp = epoch + k * PERIOD + (wind_off if k else 0)
            message = wind_to_message(WIND_CLASSES[TYPE], WindSample(stamp, 'map', *wind[k]))
            writer.write('/wind', stamp, serialize_message(message))
        for at, force, rate in zip(motion.time, motion.acceleration, motion.rate, strict=True):
            stamp = epoch + round(1e9 * at)
            message = imu_message(stamp, force, rate, None)
            writer.write('/tree/imu', stamp, serialize_message(message))


def error_at(lag: float, at: Floats, found: Floats, known: Floats) -> float:
    """Compare tips at times [s] with those of `simulate`, (n, 3), later by a lag [s]."""
    ends = np.arange(1, len(known) + 1) / 60.0
    wanted = np.stack([np.interp(at - lag, ends, column) for column in known.T], axis=1)
    return float(np.sqrt(np.var(found - wanted, axis=0).sum() / np.var(wanted, axis=0).sum()))


@pytest.mark.parametrize(
    ('motion_off', 'wind_off', 'most'),
    [
        pytest.param(0, 0, 0.03, marks=pytest.mark.long),
        # Between two samples the noise of the sensor is another, and half as large.
        (3_000_000, 5_000_000, 0.05),
    ],
    ids=['on the steps', 'between the steps'],
)
def test_player_and_solver_give_what_simulate_gives(
    compose: Any, observer: Any, monkeypatch: pytest.MonkeyPatch, tmp_path: Path,
    motion_off: int, wind_off: int, most: float,
) -> None:  # fmt: skip
    bag = str(tmp_path / 'bag')
    write_bag(Path(bag), motion_off=motion_off, wind_off=wind_off)
    epoch = START + motion_off
    wind, motion = read_wind(bag), read_imu_bag(Path(bag))
    # Where motion is known, the wind of a period ago is.
    times = motion.times_after(wind.epoch) - LATE
    placed = PlacedMotion('tree/imu', AT, times, motion.acceleration, motion.rate)
    with monkeypatch.context() as patch:
        told = property(lambda wind: LATE, lambda wind, late: None)
        patch.setattr(LateWind, 'known_late', told, raising=False)
        followed, alone = (
            simulate(TREE, wind, motion=sensors).tips[:, 0] for sensors in ([placed], [])
        )
    frames = observer.listen(SEGMENT_POSES, raw=True, depth=4000)
    nodes = compose(
        player={
            'file': bag, 'reader_options': 'topic=/wind', 'imu': 'tree/imu', 'loop': False,
            'publish_clock': True, 'rate': 2.0,
        },
        wind={'use_sim_time': True},
        solver={
            'tree': 'goldcrest', 'imu': f'tree/imu@{AT}', 'use_sim_time': True,
            'wind_delay': DELAY,
        },
    )  # fmt: skip
    end = epoch + (SECONDS - 1) * 10**9
    observer.until(lambda: frames and stamp_of(frames[-1]) > end, 'the end', deadline=120.0)
    nodes.close()
    by_stamp = {stamp_of(frame): frame for frame in frames}
    # From when the mounting is known in both; before, both follow the wind alone.
    scored = [stamp for stamp in sorted(by_stamp) if stamp > epoch + 25 * 10**9]
    assert len(scored) > 300
    rest = tips_of_poses(TREE, make_simulator(TREE).place())[TIP]
    poses = [poses_of(by_stamp[stamp]) for stamp in scored]
    found = np.array([tips_of_poses(TREE, each)[TIP] - rest for each in poses])
    at = 1e-9 * (np.array(scored) - epoch)
    lags = np.arange(DELAY - 0.1, DELAY + 0.3, 0.25 * DT)
    errors = [error_at(lag, at, found, followed) for lag in lags]
    lag = float(lags[int(np.argmin(errors))])
    print(f'error {min(errors):.4f} at {lag:.3f} s; {error_at(lag, at, found, alone):.2f} alone')
    # The wind acts after its delay and a period of its own.
    assert lag == pytest.approx(DELAY + LATE, abs=2.5 * DT)
    assert min(errors) < most
    assert error_at(lag, at, found, alone) > 0.2
