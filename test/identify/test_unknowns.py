"""Unknowns of a model as one vector: what goes in comes out, and what a deviation costs."""

import numpy as np

from tendon_ros.identify.candidate import Candidate

RUBS = Candidate('coulomb_friction', 'pulley_2')


def test_a_vector_and_back(sound_problem):
    model = sound_problem.empty.joined(RUBS, {'torque': 0.1})
    x = sound_problem.pack(model) + np.linspace(0.1, 0.2, len(sound_problem.axes(model)))
    assert np.array_equal(sound_problem.pack(sound_problem.unpack(model, x)), x)
    assert len(sound_problem.labels(model)) == len(set(sound_problem.labels(model))) == len(x)


def test_trembling_is_held_as_tolerances_are_and_rigid_friction_is_free(sound_problem):
    model = sound_problem.empty.joined(RUBS, {'torque': 0.1})
    size, *beside = sound_problem.prior(model)
    held = dict(zip([name for _, name in model.bristle], beside, strict=False))
    # bins repeat each other, and so does what they say of the one and of the other
    tolerances = set(beside[len(held) :])
    assert tolerances == {held['dither']}
    assert held['dither'] > held['angle'] == 1.0
    assert size == 0.0
