# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
One oscillator over one step, exactly.

`propagator` gives the eight coefficients that advance ``I x'' + k2 x' + k1 x = M(t)`` over a step
for a moment that changes linearly, to the last digits for any damping and any step; the law is in
``native/propagate.cpp`` (Higham 2008, Functions of Matrices, 10.7). `guards` are the limits within
which a branch on two axes stays bounded.
"""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway.core.oscillators.propagation import fill_propagator as fill_propagator
    from tree_sway.core.oscillators.propagation import held_propagator as held_propagator
    from tree_sway.core.oscillators.propagation import propagator as propagator
    from tree_sway.core.oscillators.propagation import step_propagators as step_propagators
    from tree_sway.core.oscillators.step_guards import guards as guards
    from tree_sway.core.oscillators.step_guards import LOAD_MAX as LOAD_MAX
else:
    __getattr__, __dir__, __all__ = face(__name__)
