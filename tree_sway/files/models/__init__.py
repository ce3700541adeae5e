# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Prepared models on disk: in the cache, as ``.npz``, and as bytes of the native core.

Written whole or not at all, without pickles, and checked as they are read.
"""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway.files.models.disk_cache import use_disk_cache as use_disk_cache
    from tree_sway.files.models.model_file import read_model as read_model
    from tree_sway.files.models.model_writer import write_model as write_model
else:
    __getattr__, __dir__, __all__ = face(__name__)
