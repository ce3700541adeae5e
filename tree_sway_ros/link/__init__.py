# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Links to instruments: lines of text over TCP, UDP or a serial port, with reconnection.

Lines are parsed by `files.wind`.
"""
