# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Commands of measured trees, and the arguments of motion sensors on them."""

from typing import TYPE_CHECKING

from tree_sway.commands import commands_of
from tree_sway.faces import face

COMMANDS = commands_of(__name__)

if TYPE_CHECKING:
    from tree_sway.twin.commands.camera_arguments import filmed_motion as filmed_motion
    from tree_sway.twin.commands.learn_argument import add_learn_argument as add_learn_argument
    from tree_sway.twin.commands.learn_argument import check_learn_argument as check_learn_argument
    from tree_sway.twin.commands.learn_argument import write_learned as write_learned
    from tree_sway.twin.commands.motion_arguments import (
        add_motion_arguments as add_motion_arguments,
    )
    from tree_sway.twin.commands.motion_arguments import placed_motion as placed_motion
else:
    __getattr__, __dir__, __all__ = face(__name__)
