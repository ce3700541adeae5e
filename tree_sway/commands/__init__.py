# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The command line ``tree-sway``: one module per command.

Arguments in, text or a file out.
What a command computes lives lower.
"""
