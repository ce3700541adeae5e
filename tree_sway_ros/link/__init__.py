# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Links to instruments: lines of text over TCP, UDP or a serial port, taken up again when they break.

What a line means is for `files.wind` to know.
"""
