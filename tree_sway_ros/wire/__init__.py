# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Messages on the wire: CDR blocks, poses, markers, the description, wind.

Arrays are converted to bytes without one Python object per pose. Times of messages are decided in
``timing``.
"""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway_ros.wire.cdr import pose_array_template as pose_array_template
else:
    __getattr__, __dir__, __all__ = face(__name__)
