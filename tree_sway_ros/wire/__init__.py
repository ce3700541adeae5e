# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Messages on the wire: CDR blocks, poses, markers, the description, wind.

Arrays become bytes here without one Python object per pose.
When to send is decided in ``timing``.
"""
