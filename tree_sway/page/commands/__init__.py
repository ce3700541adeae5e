# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The command of the page, ``show``, and what its server is told by arguments."""

from typing import TYPE_CHECKING

from tree_sway.commands import commands_of
from tree_sway.faces import face

COMMANDS = commands_of(__name__)

if TYPE_CHECKING:
    from tree_sway.page.commands.addition import PageAddition as PageAddition
    from tree_sway.page.commands.page_arguments import add_page_arguments as add_page_arguments
    from tree_sway.page.commands.page_arguments import page_settings as page_settings
    from tree_sway.page.commands.page_arguments import print_address as print_address
    from tree_sway.page.commands.show import add_arguments as add_arguments
    from tree_sway.page.commands.show import build_scene as build_scene
else:
    __getattr__, __dir__, __all__ = face(__name__)
