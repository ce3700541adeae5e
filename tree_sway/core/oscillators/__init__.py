# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
One linear or two-axis oscillator over one step: exact propagator, matrix exponential, step rules.

The solver steps with these; other methods are in the laboratory. Nothing here knows of branches.
"""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway.core.oscillators.propagation import fill_propagator as fill_propagator
    from tree_sway.core.oscillators.propagation import held_propagator as held_propagator
    from tree_sway.core.oscillators.propagation import propagator as propagator
    from tree_sway.core.oscillators.step_guards import guards as guards
    from tree_sway.core.oscillators.step_guards import LOAD_MAX as LOAD_MAX
else:
    __getattr__, __dir__, __all__ = face(__name__)
