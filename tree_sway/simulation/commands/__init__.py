# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Commands of a simulated tree and its strength, and the arguments of where it stands."""

from typing import TYPE_CHECKING

from tree_sway.commands import commands_of
from tree_sway.faces import face

COMMANDS = commands_of(__name__)

if TYPE_CHECKING:
    from tree_sway.simulation.commands.exposure import (
        add_exposure_arguments as add_exposure_arguments,
    )
    from tree_sway.simulation.commands.exposure import (
        refuse_spacing_in_the_open as refuse_spacing_in_the_open,
    )
    from tree_sway.simulation.commands.exposure import (
        refuse_unused_exposure as refuse_unused_exposure,
    )
    from tree_sway.simulation.commands.strength import tallest_of_kinds as tallest_of_kinds
    from tree_sway.simulation.commands.strength import used_strength as used_strength
else:
    __getattr__, __dir__, __all__ = face(__name__)
