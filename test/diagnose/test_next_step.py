"""What to measure next: each thing to do once, with all that it separates."""

from dataclasses import replace
from types import SimpleNamespace

from tendon_ros.diagnose import next_step
from tendon_ros.diagnose.found import Found, Rival
from tendon_ros.diagnose.patience import Patience
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.identify.candidate import Candidate

RUBS = [Candidate('coulomb_friction', f'pulley_{name}') for name in 'abc']


def test_one_motion_that_separates_two_pairs_is_proposed_once(bench, monkeypatch):
    def question(likely, one, other):
        return likely, {0}, [((one, {}), (other, {}))]

    def separating(_instrument, _measured, pairs, *_):
        [((one, _), (other, _))] = pairs
        names = ((one.place, other.place),)
        common = {'separates': names, 'seconds': 6.0, 'order': 6.0}
        swing = SimpleNamespace(do='swing', add_channel='', **common)
        read = SimpleNamespace(do='swing', add_channel=f'pulley/{one.place}/position', **common)
        return [swing, read]

    questions = [question(0.9, RUBS[0], RUBS[1]), question(0.8, RUBS[1], RUBS[2])]
    monkeypatch.setattr(next_step, '_rivals', lambda *_: questions)
    monkeypatch.setattr(next_step, '_members', lambda *_: [])
    monkeypatch.setattr(next_step, 'separating', separating)
    monkeypatch.setattr(next_step, 'together', lambda suggestions: suggestions)
    problem = SimpleNamespace(rollouts=SimpleNamespace(effort=None))
    found = SimpleNamespace(final=SimpleNamespace(model=SimpleNamespace(causes=[])))
    told = next_step.next_experiments(
        bench, [], problem, found, None, 1, Patience(), lambda *_: None
    )
    assert [(one.do, one.add_channel) for one in told] == [
        ('swing', ''),
        ('swing', 'pulley/pulley_a/position'),
        ('swing', 'pulley/pulley_b/position'),
    ]
    assert told[0].separates == (('pulley_a', 'pulley_b'), ('pulley_b', 'pulley_c'))


def test_an_experiment_is_sought_for_who_takes_a_place_alone(bench, measured_on, monkeypatch):
    """Half of what does the same together is not what would have to be told from a cause."""
    problem = prepared([measured_on(bench)], bench).problem
    sided, rubs, bias, other = (
        Candidate(effect, place)
        for effect, place in (
            ('asymmetric_friction', 'pulley_M'),
            ('coulomb_friction', 'pulley_M'),
            ('torque_bias', 'motor_M'),
            ('stribeck_friction', 'pulley_M'),
        )
    )

    def fit(*causes):
        model = problem.empty
        for cause in causes:
            model = model.joined(cause, {p.name: p.typical for p in cause.parameters})
        return problem.fitted(model, rounds=0)

    found = Found(states=[fit(), fit(sided)])
    both = fit(rubs, bias)
    alike = [replace(f, cost=found.final.cost) for f in (both, fit(other))]
    found.rivals = [[Rival(rubs, alike[0]), Rival(bias, alike[0]), Rival(other, alike[1])]]
    asked = []

    def separating(_instrument, _measured, pairs, *_):
        asked.extend((one.effect, rival.effect) for (one, _), (rival, _) in pairs)
        return []

    monkeypatch.setattr(next_step, 'separating', separating)
    held = SimpleNamespace(weighed=[SimpleNamespace(chance=0.9)], companies=())
    next_step.next_experiments(bench, [], problem, found, held, 1, Patience(), lambda *_: None)
    assert asked == [('asymmetric_friction', 'stribeck_friction')]
