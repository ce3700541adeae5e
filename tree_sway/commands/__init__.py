# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The frame of the command line ``tree-sway``: what it is made of, whatever commands there are.

A house brings its commands in a wing of its own, such as `tree_sway.page.commands`: a module for
each, and a table of them. This house knows none of them.
"""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway.commands.cli import main as main
    from tree_sway.commands.command import Command as Command
    from tree_sway.commands.command import commands_of as commands_of
    from tree_sway.commands.ending import Ending as Ending
    from tree_sway.commands.entries import additions as additions
    from tree_sway.commands.entries import own_commands as own_commands
    from tree_sway.commands.progress import bar as bar
    from tree_sway.commands.progress import counting as counting
    from tree_sway.commands.progress import waiting as waiting
    from tree_sway.commands.refusals import refuse_overwriting as refuse_overwriting
    from tree_sway.commands.refusals import refuse_unused as refuse_unused
    from tree_sway.commands.row_file import RowFile as RowFile
    from tree_sway.commands.said import say as say
else:
    __getattr__, __dir__, __all__ = face(__name__)
