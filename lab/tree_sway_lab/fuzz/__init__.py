# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Damaged messages for every reader of foreign bytes on a line, by their numbers.

Read `command`, then `doors`: what is offered to each process. `mutation` damages bytes, also those
of files (``test/files/test_fuzz.py``).
"""
