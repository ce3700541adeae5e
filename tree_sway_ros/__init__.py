"""Trees that sway as the wind blows: a reduced model of a tree and the ROS 2 nodes around it."""

__version__ = "0.1.0"
