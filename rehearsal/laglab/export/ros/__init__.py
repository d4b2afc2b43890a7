"""A run as ROS 2 messages."""
