# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The browser page and its server.

`server` sends a stream to any number of browsers: `guard` checks their requests, `page_client` is
one of them, `published` what they are sent. `session` is a live tree without ROS.
``static/`` has the page: our own ES modules, without external ones.
"""
