# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The sketch for an ESP32, compiled for this computer: what it sends is read as motion."""

from __future__ import annotations

from pathlib import Path
import shutil
import subprocess

import pytest

from tree_sway.live.motion.motion_json import read_motion_json
from tree_sway.live.motion.motion_reading import MotionReading
from tree_sway.live.transports.transport import Message

SKETCH = Path(__file__).resolve().parents[2] / 'examples' / 'esp32_imu' / 'esp32_imu.ino'
#: Stand-ins of the libraries of the board: the sensor's registers hold known values.
STANDS = """
#include <cstdint>
#include <cstdio>
#include <string>
static uint32_t passed = 0;
uint32_t micros() { return passed += 1000; }
uint32_t millis() { return passed / 1000; }
enum { WIFI_STA, WL_CONNECTED };
struct {
  void mode(int) {}
  void setSleep(bool) {}
  void begin(const char *, const char *) {}
  int status() { return WL_CONNECTED; }
} WiFi;
struct {
  int at = 0;
  int16_t values[7] = {0, -8192, 16384, 521, 131, -262, 0};
  void begin() {}
  void beginTransmission(int) {}
  void write(int) {}
  int endTransmission(bool = true) { return at = 0; }
  int requestFrom(uint8_t, uint8_t count) { return count; }
  int read() {
    int value = (uint16_t)values[at / 2];
    return at++ % 2 ? value & 255 : value >> 8;
  }
} Wire;
struct WiFiUDP {
  void beginPacket(const char *, uint16_t) {}
  void write(const uint8_t *data, int length) { fwrite(data, 1, length, stdout); }
  void endPacket() { puts(""); }
};
"""


def test_its_samples_are_read(tmp_path: Path) -> None:
    compiler = shutil.which('g++') or shutil.which('clang++')
    if compiler is None:
        pytest.skip('no C++ compiler')
    for name in ('WiFi.h', 'WiFiUdp.h', 'Wire.h'):
        (tmp_path / name).write_text('#pragma once\n')
    program = f'{STANDS}\n#include "{SKETCH}"\nint main() {{ setup(); while (passed < 200000) '
    (tmp_path / 'main.cpp').write_text(program + 'loop(); }\n')
    built = subprocess.run(
        [compiler, '-Wall', '-Werror', '-I', str(tmp_path), 'main.cpp', '-o', 'main'],
        cwd=tmp_path, capture_output=True, text=True, timeout=120, check=False,
    )  # fmt: skip
    assert built.returncode == 0, built.stderr
    sent = subprocess.run([tmp_path / 'main'], capture_output=True, timeout=20, check=True).stdout
    times = []
    for line in sent.splitlines():
        (found,) = read_motion_json(Message(line))
        assert isinstance(found, MotionReading)
        assert found.acceleration == pytest.approx((0.0, -4.9033, 9.8066), abs=1e-4)
        assert found.rate == pytest.approx((0.01745, -0.03491, 0.0), abs=1e-5)
        assert found.time is not None
        times.append(found.time)
    assert len(times) >= 8
    # Fifty samples in a second, by a clock of milliseconds.
    assert (times[-1] - times[0]) / (len(times) - 1) == pytest.approx(20.0, abs=2.0)
