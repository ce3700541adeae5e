# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Monitoring of a stream: messages, statistics, text.

Memory does not grow with the length of a stream.
"""
