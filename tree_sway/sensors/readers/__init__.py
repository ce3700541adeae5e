# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What the messages of instruments mean: lines, JSON, forms; one file a format."""
