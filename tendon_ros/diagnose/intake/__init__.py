"""What comes before any fit: recordings that can be relied on, and what had to be left out."""

from tendon_ros.diagnose.intake.admission import admitted, Intake

__all__ = ['admitted', 'Intake']
