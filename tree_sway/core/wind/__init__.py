# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The wind from a sensor to what the trees feel: convention, gate, mean over a step, profile, travel.

One way in: units, sign and limits are settled here and nowhere else.
Nothing here knows of trees or of messages.
"""
