# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Lines of instruments of a maker: one module each, with its reader.

Each module has one `LineFormat` or more, which `InstrumentLines` finds.
"""
