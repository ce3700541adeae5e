# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Sphinx: the pages of this folder, and the API from the docstrings."""

from pathlib import Path
import re
import sys

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

project = 'tree_sway_ros'
author = 'Tree Sway maintainers'
copyright = f'2026 {author}'
release = re.search(r"__version__ = '(.+)'", (ROOT / 'tree_sway' / '__init__.py').read_text())[1]
extensions = ['myst_parser', 'sphinx.ext.autodoc', 'sphinx.ext.napoleon']
master_doc = 'index'
exclude_patterns = ['build']
html_theme = 'alabaster'
html_theme_options = {'description': 'Trees that sway in measured wind', 'page_width': '1200px'}
myst_heading_anchors = 3
autodoc_default_options = {'members': True, 'show-inheritance': True}
autodoc_typehints = 'none'
napoleon_google_docstring = False
napoleon_use_ivar = True
suppress_warnings = ['myst.xref_missing', 'misc.highlighting_failure']
