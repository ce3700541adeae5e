# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Run: one tree, step by step.

`SwaySimulator` takes a wind and a length of time, and gives poses: `bank` is the tree ready to be
stepped, `table_model` the default law on a table of winds, `branch_oscillators` the method of
Kanda & Ohya branch by branch, `rigid` the tree that the wind does not move; `assembly` chooses
among them by the name of the model. `pushes` are the forces of a hand, `tuning` changes stiffness,
damping and weight while the tree sways, `clamp_watch` leaves coordinates out where a step stays
clamped. `Outcome` is what a step says of itself.

It is thin: the law is in ``native/`` (``table.h``, ``limp.h``, ``place.h``, ``branch.h``), its
equations in ``doc/sway_model.md``. Many trees are in the house `scene`.
"""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway.core.run.assembly import native_stand as native_stand
    from tree_sway.core.run.bank import Bank as Bank
    from tree_sway.core.run.bank import Oscillators as Oscillators
    from tree_sway.core.run.clamp_watch import ClampWatch as ClampWatch
    from tree_sway.core.run.clamp_watch import fewer as fewer
    from tree_sway.core.run.far_crown import FarCrown as FarCrown
    from tree_sway.core.run.modal_coordinates import FARTHEST as FARTHEST
    from tree_sway.core.run.modal_coordinates import ModalCoordinates as ModalCoordinates
    from tree_sway.core.run.outcome import Outcome as Outcome
    from tree_sway.core.run.pushes import MOST_PUSHES as MOST_PUSHES
    from tree_sway.core.run.pushes import row_of as row_of
    from tree_sway.core.run.pushes import Spring as Spring
    from tree_sway.core.run.pushes import Touch as Touch
    from tree_sway.core.run.simulator import Counts as Counts
    from tree_sway.core.run.simulator import Motion as Motion
    from tree_sway.core.run.simulator import rows_of_tree as rows_of_tree
    from tree_sway.core.run.simulator import SwaySimulator as SwaySimulator
    from tree_sway.core.run.simulator import TreeGroup as TreeGroup
    from tree_sway.core.run.simulator_basis import basis_of as basis_of
    from tree_sway.core.run.table_model import bent_too_far as bent_too_far
    from tree_sway.core.run.table_model import come_to_rest as come_to_rest
    from tree_sway.core.run.table_model import STATE_FIELDS as STATE_FIELDS
    from tree_sway.core.run.table_model import TableOscillators as TableOscillators
    from tree_sway.core.run.tuning import LiveTuning as LiveTuning
    from tree_sway.core.run.tuning import Tuning as Tuning
else:
    __getattr__, __dir__, __all__ = face(__name__)
