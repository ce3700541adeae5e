# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
When to step and when to send: the pacer, uneven steps, playback of records.

Time is integer nanoseconds.
What is sent is made in ``wire``.
"""
