# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Processes: start, spin and end a node; several nodes in one process; topics and their QoS.

Exceptions in callbacks do not end an executor. Nodes are in ``nodes``.
"""
