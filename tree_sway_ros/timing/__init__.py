# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Times of steps and messages: the pacer, uneven steps, playback of records.

Time is integer nanoseconds. Messages are made in ``wire``.
"""
