# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Parts of the solver node, each beside the order of its steps, and the hooks of its annexes.

An annex is a sensor, or whatever else belongs to the steps, that the node does not know by name.
"""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway_ros.solver.annex import annexes_of as annexes_of
    from tree_sway_ros.solver.annex import simulator_by as simulator_by
    from tree_sway_ros.solver.annex import SolverAnnex as SolverAnnex
    from tree_sway_ros.solver.demand import Demand as Demand
    from tree_sway_ros.solver.hands import take_pushes_and_pulls as take_pushes_and_pulls
    from tree_sway_ros.solver.opening import scene_of as scene_of
    from tree_sway_ros.solver.opening import settings_of as settings_of
    from tree_sway_ros.solver.questions import answer_questions as answer_questions
    from tree_sway_ros.solver.sample_wait import SampleWait as SampleWait
    from tree_sway_ros.solver.sample_wait import UNHEARD as UNHEARD
    from tree_sway_ros.solver.services import offer_services as offer_services
    from tree_sway_ros.solver.state_publisher import StatePublisher as StatePublisher
else:
    __getattr__, __dir__, __all__ = face(__name__)
