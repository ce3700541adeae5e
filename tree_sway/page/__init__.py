# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The page in the browser, and its server.

`Session` is a live tree without ROS, `PageServer` sends it to any number of browsers (`guard`
checks requests, `page_client` is one of them), `page_of_scene` makes one HTML file that sways by
itself, and `page_pictures` draws the page without a screen. ``static/`` is the page: ES modules of
our own and the native core as ``sway.wasm``.
"""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway.page.access import read_token as read_token
    from tree_sway.page.film import browser as browser
    from tree_sway.page.film import page_pictures as page_pictures
    from tree_sway.page.one_file import page_of_scene as page_of_scene
    from tree_sway.page.page_settings import PageSettings as PageSettings
    from tree_sway.page.server import PageServer as PageServer
    from tree_sway.page.session import Choices as Choices
    from tree_sway.page.session import RATE as RATE
    from tree_sway.page.session import Session as Session
else:
    __getattr__, __dir__, __all__ = face(__name__)
