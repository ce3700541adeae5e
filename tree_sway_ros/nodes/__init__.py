"""
rclpy entry points: one node class per file.

A node converts, calls and publishes.
No arithmetic beyond units.

"""
