# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Speed against accuracy as pictures and tables.

One file per chart.
The numbers come from benches and references.

"""
