"""Between arrays and ROS messages: topics, parameters, bytes."""
