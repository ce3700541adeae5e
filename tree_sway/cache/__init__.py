# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What is kept on disk between runs: the set-ups of trees, by a digest of all they depend on."""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway.cache.folder import cache_folder as cache_folder
    from tree_sway.cache.model_cache import MODELS as MODELS
    from tree_sway.cache.source import ROOT as ROOT
    from tree_sway.cache.source import source_digest as source_digest
else:
    __getattr__, __dir__, __all__ = face(__name__)
