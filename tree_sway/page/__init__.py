# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The browser page: what goes over a thin line, the server that sends it, and the page's own modules.

`protocol` is the binary form, `description` what a receiver needs to rebuild every pose, `server`
sends both to any number of browsers, `session` is a live tree without ROS. ``static/`` holds the
page: ES modules of our own, nothing from elsewhere.
"""
