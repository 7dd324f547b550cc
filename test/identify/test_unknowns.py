"""Unknowns of a model as one vector: what goes in comes out, and what a deviation costs."""

import numpy as np

from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.explanation import BRISTLES

RUBS = Candidate('coulomb_friction', 'pulley_2')


def test_a_vector_and_back(sound_problem):
    model = sound_problem.empty.joined(RUBS, {'torque': 0.1})
    x = sound_problem.pack(model) + np.linspace(0.1, 0.2, len(sound_problem.axes(model)))
    assert np.array_equal(sound_problem.pack(sound_problem.unpack(model, x)), x)
    assert len(sound_problem.labels(model)) == len(set(sound_problem.labels(model))) == len(x)


def test_what_friction_has_beside_its_size_is_held_as_tolerances_are(sound_problem):
    size, *beside = sound_problem.prior(sound_problem.empty.joined(RUBS, {'torque': 0.1}))
    assert size == 0.0
    assert len(beside) == len(BRISTLES) + len(sound_problem.tolerances)
    # bins repeat each other, and so does what they say of the one and of the other
    assert set(beside) == {beside[-1]}
    assert beside[-1] > 1.0
