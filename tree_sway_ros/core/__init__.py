"""The numeric core: numpy, scipy and numba only, no ROS, files, clock or logging."""
