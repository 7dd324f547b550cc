"""How finely rollouts are integrated: by how finely angles are counted."""

from __future__ import annotations

from tendon_ros.model.instrument import Instrument

#: [rad] a step; a hundredth of an encoder's count
TOLERANCE = 4e-6
#: [rad] what rollouts may be integrated by, the roughest first. A load cell on a stiff contact
#: notices a tenth of what encoders do
STEPS = (1e-4, 2e-5, TOLERANCE, 1e-6, 2.5e-7, 6e-8)
#: how much rougher first looks are, which go by much more than noise
ROUGHER = 25.0
#: [rad] counts that are finer ask for finer steps: on a straight axis a radian stands for a metre,
#: and friction builds up over some micrometres
FINE = 2e-5


def fineness(instrument: Instrument) -> float:
    """
    Return how much finer than usual an instrument's angles are to be computed.

    :param instrument: the network.
    :return: 1, or less where a motor's encoder counts finer than any of a joint.
    """
    counts = [s.resolution for s in instrument.sensors if s.kind == 'angle' and s.resolution > 0.0]
    return min([1.0, *(count / FINE for count in counts)])
