# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Recordings of a swaying tree: rosbag2 bags, MCAP or sqlite3, written and read without ROS.

`bag_writer` writes messages as bytes, `bag_reader` reads them.
"""
