# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Arguments of motion sensors and cameras, which commands of other houses take."""

from typing import TYPE_CHECKING

from tree_sway.faces import face

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
