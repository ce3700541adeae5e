"""The four ROS 2 executables: anemometer, wind, solver, player."""
