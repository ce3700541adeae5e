# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``python -m tree_sway``, where the command ``tree-sway`` is not on the path."""

import sys

from tree_sway.commands import main

sys.exit(main())
