"""Where numbers are guesses a search begins with all that usually is there, and keeps little."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.diagnose.everywhere import everywhere, thinned_out, USUAL
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.diagnose.steps import Steps
from tendon_ros.identify.candidate import everyone
from tendon_ros.identify.explanation import Model
from tendon_ros.model.instrument_file import load_instrument


def test_all_that_transmissions_usually_have(bench):
    candidates = everyone(bench, [s.channel for s in bench.sensors])
    model = everywhere(candidates, Model((), (), {}, np.zeros(0)))
    places = {(c.effect, c.place) for c in model.causes}
    assert places == {(c.effect, c.place) for c in candidates if c.effect in USUAL}
    assert {effect for effect, _ in places} == set(USUAL)
    for k, cause in enumerate(model.causes):
        assert model.values(k) == pytest.approx({p.name: p.typical for p in cause.parameters})


def test_only_what_is_needed_stays(measured_on):
    axis = load_instrument('driven_axis')
    pulleys = tuple(replace(p, inertia=0.5 * p.inertia) for p in axis.pulleys)
    friction = ('coulomb_friction', 'pulley_axis', {'torque': 0.05})
    settings = (('duration', '6 s'), ('amplitude', '40 deg'))
    run = measured_on(replace(axis, pulleys=pulleys), friction, settings=settings)
    problem = prepared([run], axis).problem
    candidates = everyone(axis, sorted(run.channels))
    assert sum(c.effect in USUAL for c in candidates) > 2
    steps = Steps(problem, candidates, 1, lambda *_: None)
    fit = thinned_out(steps, problem.fitted(problem.empty), 8)
    assert [(c.effect, c.place) for c in fit.model.causes] == [friction[:2]]
    assert problem.structured(fit.left) < 0.1
