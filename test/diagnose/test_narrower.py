"""The plain friction that a law holds is asked from where that law has brought everything else."""

from dataclasses import replace

import pytest

from tendon_ros.diagnose.prepare import prepared
from tendon_ros.diagnose.steps import Steps
from tendon_ros.diagnose.warm_start import Begun
from tendon_ros.identify.candidate import Candidate, everyone
from tendon_ros.model.effect_use import EffectUse
from tendon_ros.model.instrument_file import load_instrument

SIDED = Candidate('asymmetric_friction', 'pulley_arm')
MOTION = (('duration', '8 s'), ('amplitude', '40 deg'))


@pytest.mark.parametrize('listed', [True, False])
def test_plain_friction_is_fitted_from_where_a_law_that_holds_it_has_gone(measured_on, listed):
    arm = load_instrument('pendulum_arm')
    weight = [use for use in arm.effects if use.effect == 'gravity']
    some = EffectUse('coulomb_friction', 'pulley_arm', {'torque': 0.02})
    known = {'pulley_arm.coulomb_friction.torque': 0.25} if listed else {}
    file = replace(
        arm,
        effects=(*weight, *([some] if listed else [])),
        tolerances=arm.tolerances | known,
    )
    true = ('coulomb_friction', 'pulley_arm', {'torque': 0.08})
    run = measured_on(replace(file, effects=tuple(weight)), true, settings=MOTION)
    problem = prepared([run], file).problem
    candidates = everyone(file, sorted(run.channels))
    [plain] = [c for c in candidates if (c.effect, c.place) == true[:2]]
    assert bool(plain.given) is listed
    # more one way than the other, and the rest has gone along with it
    state = problem.fitted(problem.empty.joined(SIDED, {'forward': 0.09, 'backward': 0.03}))
    begun = Begun(Steps(problem, candidates, 1, lambda *_: None))
    [rival] = begun.narrower(state, SIDED)
    assert rival.candidate == plain
    assert rival.fit.cost < 1.05 * state.cost
    assert begun.narrower(problem.fitted(problem.empty.joined(plain, true[2])), plain) == []
