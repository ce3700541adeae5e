# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Live motion sensors on the real tree: a phone with phyphox, and JSON over UDP, MQTT or a port.

The transports are those of the wind; `live_motion` brings the samples to one clock.
"""
