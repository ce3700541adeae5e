# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Accelerations as apps of phones write them, for a tree's frequency."""

from pathlib import Path

import numpy as np
import pytest

from tree_sway.files.wind.sway_table import read_csv_sway
from tree_sway.identification.measured_sway import estimate_sway

TIME = np.arange(0.0, 40.0, 0.05)
PULL = 0.8 * np.exp(-0.05 * 2.0 * np.pi * 0.5 * TIME) * np.cos(2.0 * np.pi * 0.5 * TIME)
BEGIN = 1_700_000_000_000_000_000


def rows(pattern: str) -> str:
    lines = (
        pattern.format(t=t, n=BEGIN + int(1e9 * t), a=a, g=a / 9.80665)
        for t, a in zip(TIME, PULL, strict=True)
    )
    return '\n'.join(lines)  # fmt: skip


APPS = {
    'phyphox': '"Time (s)","Linear Acceleration x (m/s^2)","Linear Acceleration y (m/s^2)",'
    '"Linear Acceleration z (m/s^2)","Absolute acceleration (m/s^2)"\n'
    + rows('{t:.9E},{a:.9E},0.0,1.0E-3,{a:.9E}'),
    'phyphox in German': '"Zeit (s)";"Lineare Beschleunigung x (m/s²)";"Lineare Beschleunigung y '
    '(m/s²)";"Absolute Beschleunigung (m/s²)"\n'
    + rows('{t:.9E};{a:.9E};0.0;{a:.9E}').replace('.', ','),
    'Sensor Logger': 'time,seconds_elapsed,z,y,x\n' + rows('{n},{t:.6f},0.01,{a:.7f},0.02'),
    'Physics Toolbox': 'time,gFx,gFy,gFz,TgF\n' + rows('{t:.3f},{g:.5f},0.0,1.0,1.0'),
    'Physics Toolbox, linear': 'time;ax;ay;az;aT\n' + rows('{t:.3f};{a:.5f};0.0;0.0;{a:.5f}'),
    'strain gauge': 'time [ms]\tstrain_1 [ustrain]\n'
    + rows('{t:.2f}\t{a:.6f}').replace('\t', 'e3\t'),
}  # fmt: skip


@pytest.mark.parametrize('name', APPS)
def test_the_frequency_of_a_pull_by_phone(name: str, tmp_path: Path) -> None:
    path = tmp_path / 'record.csv'
    path.write_text(APPS[name], encoding='utf-8')
    record = read_csv_sway(path)
    assert record.quantity == ('strain' if name == 'strain gauge' else 'acceleration')
    found = estimate_sway(record.time, record.motion)
    assert found.frequency == pytest.approx(0.5, rel=0.01)
    assert found.damping_ratio == pytest.approx(0.05, rel=0.1)
