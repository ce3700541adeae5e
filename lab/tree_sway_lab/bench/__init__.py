# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
What a step costs, against a stated baseline in the same run.

Ratios first, as machines are noisy.
No test asserts a time.

"""
