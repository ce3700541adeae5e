# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Messages on the wire: CDR blocks, poses, markers, the description, wind.

Arrays are converted to bytes without one Python object per pose. Times of messages are decided in
``timing``.
"""
