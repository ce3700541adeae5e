# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The stream of a scene: description, frames, tables; what receivers place and solve by.

`doc/streaming.md` is the specification.
"""
