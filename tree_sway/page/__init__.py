# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The browser page: the stream, its server, and the modules of the page.

`protocol` is the binary form, `description` the data by which a receiver computes every pose,
`server` sends both to any number of browsers, `session` is a live tree without ROS. ``static/``
has the page: our own ES modules, without external ones.
"""
