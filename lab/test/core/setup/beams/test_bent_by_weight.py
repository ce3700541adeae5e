# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Hanging twigs swing as fast as when every segment is solved."""

from __future__ import annotations

import numpy as np
from tree_sway_lab.kinds.kinds import kind_called
from tree_sway_lab.validation.truth import FINE, SETTINGS, true_frequencies, WOOD

from tree_sway.core.setup import reduced_tree
from tree_sway.core.setup.beams import branch_model
from tree_sway.core.setup.reductions import TreeReductions


def test_hanging_twigs_swing_as_fast_as_when_every_segment_is_solved(monkeypatch):
    tree = kind_called('birch')
    true = true_frequencies(tree, 12, FINE)
    # Plain twigs: a further pair would help.
    monkeypatch.setattr(reduced_tree, 'STRUNG', 0.0)

    def largest():
        found = TreeReductions(tree, WOOD, SETTINGS).natural_frequencies(12)
        return np.abs(found / true - 1.0).max()

    assert largest() < 0.004
    monkeypatch.setattr(branch_model, 'bent_by_weight', lambda *given: given[3])
    assert largest() > 0.015
