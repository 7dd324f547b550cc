"""The ROS 2 nodes: thin shells that declare, convert, call the core and publish."""

from tendon_ros.base.threads import use_one_thread

use_one_thread()
