"""The command line: one verb a file, found by its name."""

from tendon_ros.base.threads import use_one_thread

use_one_thread()
