"""The ROS 2 nodes: thin shells that declare, convert, call the core and publish."""
