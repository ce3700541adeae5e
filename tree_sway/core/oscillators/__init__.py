# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
One linear or two-axis oscillator over one step: exact propagator, matrix exponential, step rules.

Everything the solver steps with; what methods do side by side is in ``study/methods``.
Nothing here knows of branches.
"""
