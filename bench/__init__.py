"""The package measured: kernel, estimates and diagnoses, against others and what is known."""

from tendon_ros.base.threads import use_one_thread

# before numpy is imported, as `tendon` does: one recording then gives one answer
use_one_thread()
