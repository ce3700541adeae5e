# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Wind records: TOA5, NMEA 0183, tables, bags; records of sway for calibration.

All result in times in [s] and velocities in [m/s], blowing TO, ENU. Gating and averaging are done
in ``core/wind``.
"""
