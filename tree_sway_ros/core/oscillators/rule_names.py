# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Names of the step rules that the solver can run, for who only asks what there is to choose."""

from __future__ import annotations

DEFAULT = 'exact_foh'
"""The exact propagator with a first-order hold."""

CONDITIONALLY_STABLE = ('semi_implicit_euler', 'verlet', 'rk4')
"""Those that have a `step_rules.stability_limit`: a step can be too long for them."""

REAL_TIME = (*CONDITIONALLY_STABLE, 'implicit_midpoint', 'tr_bdf2', 'exact_zoh', DEFAULT)
"""All of them, as the setting ``integrator`` takes them."""
