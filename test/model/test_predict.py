"""Prediction along given motion: what stands still must let go in time."""

import numpy as np

from tendon_ros.model.paper.rig import paper_rig, with_effects
from tendon_ros.model.signals import Signals
from tendon_ros.model.simulation import predict
from tendon_ros.model.trajectory_profiles import paper_fig12


def test_a_stuck_pulley_lets_go_while_all_else_rests():
    """
    With all stuck the error of a step is zero however long; breakaway must be seen all the same.

    The largest force of the plateau at 7 degrees depends on pulley 1 letting go on the way up.
    """
    rig = with_effects(
        paper_rig(),
        [
            ('pretension', 'cable_L3', {'scale': 0.9}),
            ('tension_friction', 'pulley_1', {'coefficient': 0.1}),
        ],
    )
    setpoints = paper_fig12(rig.motor_names).sample(1e-3)
    motion = Signals.through(0.0, 1e-3, setpoints.T)
    loose, tight = (
        predict(rig, motion, rig.driven, len(setpoints) - 1, tolerance=t) for t in (1e-7, 1e-9)
    )
    assert 40.0 < tight.contact_force.max() < 50.0
    # where it lets go a moment sooner the stiff wall feels it; to stay stuck would cost 28 N
    assert np.abs(loose.contact_force - tight.contact_force).max() < 0.1


def test_motion_that_begins_moving_is_followed_from_the_first_sample():
    """The first effort of a signal with a slope holds the damping of that slope."""
    rig = paper_rig()
    time = np.arange(400) * 1e-3
    motion = Signals.smooth(0.0, 1e-3, np.array([0.1 * time, 0.0 * time]))
    rows = predict(rig, motion, rig.driven, 300)
    damping = rig.pulleys[0].damping
    assert abs(rows.effort[0, 0] - 0.1 * damping) < 1e-3 * damping
