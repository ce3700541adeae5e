# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Live instruments: links over a network or a serial port, and what their messages mean.

``transports`` delivers messages as bytes and reconnects; ``sources`` has one file per kind of
source, which puts a transport and a reader together; the registry opens one by its address.
"""
