# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Simulators that the general tests try: those of the core, and those of annexes that are there.

A simulator of an annex, a tree that follows sensors or the model ``full`` of the laboratory, has
to pass the tests of all simulators. The tests of the core pass without it.
"""

from __future__ import annotations

from importlib.util import find_spec

import numpy as np
import pytest

from tree_sway.core.scene.make import make_simulator
from tree_sway.core.wind.turbulence import simulate_turbulence


def _of_annex(model, module):
    there = find_spec(module) is not None
    return [pytest.param(model, marks=pytest.mark.annex)] if there else []


FULL = _of_annex('full', 'tree_sway_lab')
"""All coordinates with the load of every branch, where the laboratory is."""

OBSERVED = _of_annex('observed', 'tree_sway.twin')
"""A tree that follows sensors, where that annex is."""

AUTO = _of_annex('auto', 'tree_sway.fidelity')
"""As few coordinates as suffice, where that annex is."""

MODELS = [*AUTO, 'branch', *FULL]
"""Models with a name."""


def swaying(tree, model, **changes):
    """Make a simulator of a tree."""
    if model == 'observed':
        from tree_sway.twin.observed_tree import ObservedTree

        return ObservedTree(tree, at={'phone': 'stem:0.5'}, **({'model': 4} | changes))
    return make_simulator(tree, model=model, **changes)


def turbulence(speed, seconds, seed=0):
    """Return turbulence at 60 Hz in [m/s], (t, 3)."""
    rng = np.random.default_rng(seed)
    return simulate_turbulence(speed, rate=60.0, duration=seconds, rng=rng)
