# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The command line ``tree-sway``: one module per command.

They convert arguments to text or a file. Computations are in rooms below.
"""
