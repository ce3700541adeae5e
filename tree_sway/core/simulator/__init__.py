# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A tree that sways: settings, calibration, ``step`` and ``place``.

One class per kind of simulator, all with the same protocol. The choice of the model is in the room
``fidelity``.
"""
