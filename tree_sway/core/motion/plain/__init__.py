# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The same steps and placing in numpy.

They run where numba is missing, and are the oracles of the compiled kernels in tests.
"""
