# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
One linear or two-axis oscillator over one step: exact propagator, matrix exponential, step rules.

The solver steps with these; other methods are in the laboratory. Nothing here knows of branches.
"""
