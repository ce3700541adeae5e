# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The browser page and its server.

`server` sends a stream to any number of browsers, `session` is a live tree without ROS.
``static/`` has the page: our own ES modules, without external ones.
"""
