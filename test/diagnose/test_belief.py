"""What makes up for one another is named as a set; what spoils nothing is kept, named or not."""

from dataclasses import replace
import math

import pytest

from tendon_ros.diagnose import session
from tendon_ros.diagnose.belief import _happening, _open, belief
from tendon_ros.diagnose.bent import spent
from tendon_ros.diagnose.compensating import _grown, companies, MAKES_UP, rubbing
from tendon_ros.diagnose.found import Found, Rival
from tendon_ros.diagnose.judge import equals, IDLE, signs_beside, stays
from tendon_ros.diagnose.naming import NAMED
from tendon_ros.diagnose.plausible import is_at_end
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.diagnose.search import Search
from tendon_ros.identify.candidate import Candidate, everyone
from tendon_ros.identify.screening import Screen
from tendon_ros.model.instrument_file import load_instrument

COULOMB = Candidate('coulomb_friction', 'pulley_3')
TENSION = Candidate('tension_friction', 'pulley_3')
GAIN = Candidate('torque_gain', 'motor_L')


def ends_with(ready, *begun):
    """Return what a search leaves that ends with given causes."""
    problem = ready.problem
    model = problem.empty
    for candidate, values in begun:
        model = model.joined(candidate, values)
    start, final = problem.fitted(problem.empty), problem.fitted(model)
    every = range(len(begun))
    return ready, Found(
        states=[start, final],
        rivals=[[] for _ in every],
        without=[problem.fitted(final.model.without(k)) for k in every],
    )


@pytest.fixture(scope='module')
def found_of(bench, measured_on):
    """Return a way to what a search would leave that ends with given causes, of one bench."""
    run = measured_on(
        bench,
        ('coulomb_friction', 'pulley_3', {'torque': 0.1}),
        ('torque_gain', 'motor_L', {'gain': 1.1}),
    )
    ready = prepared([run], bench)
    return lambda *begun: ends_with(ready, *begun)


@pytest.fixture(scope='module')
def alike(found_of):
    """Return a search that ended with two frictions of one pulley, and a torque constant."""
    return found_of(
        (COULOMB, {'torque': 0.05}), (TENSION, {'coefficient': 0.03}), (GAIN, {'gain': 1.1})
    )


def test_who_may_as_well_have_no_size_is_not_named_unless_it_stands_for_others(alike):
    ready, found = alike
    held = belief(ready, found)
    held = replace(held, named=dict(enumerate(held.weighed)), companies=((0, 1),))
    doubted = held.doubting([0, 2])
    assert set(doubted.named) == {0, 1}
    assert doubted.weighed[2].chance == IDLE < held.weighed[2].chance
    assert doubted.weighed[:2] == held.weighed[:2]


def test_causes_that_make_up_for_one_another_are_certain_together(alike):
    ready, found = alike
    judged = belief(ready, found)
    apart = [found.without[k].cost - found.final.cost for k in (0, 1)]
    both = ready.problem.fitted(found.final.model.without(0, 1)).cost - found.final.cost
    assert both > 2.0 * sum(apart)
    [company] = companies(ready, found, judged.weighed, [0, 1], stays(ready, found.final))
    first = max((0, 1), key=lambda k: apart[k])
    assert company.members == (first, 1 - first)
    assert company.weighed.cause == found.final.model.causes[first]
    assert company.weighed.equal == (found.final.model.causes[1 - first],)
    assert company.weighed.signs.worth > judged.weighed[first].signs.worth


def test_much_that_stays_without_what_undoes_each_other_speaks_against_a_company(alike):
    ready, found = alike
    weighed = belief(ready, found).weighed
    [company] = companies(ready, found, weighed, [0, 1], stays(ready, found.final))
    power = 10.0 * company.weighed.signs.worth
    much = replace(
        stays(ready, found.final),
        by_channel=dict.fromkeys(ready.problem.channels(), power),
        whole=power,
    )
    assert companies(ready, found, weighed, [0, 1], much) == []


def test_dry_frictions_that_are_each_uncertain_are_one(alike):
    """By which law, and where, cannot be said; that something rubs can."""
    ready, found = alike
    able = range(len(found.final.model.causes))
    weighed = [replace(w, chance=0.3) for w in belief(ready, found).weighed]
    left = stays(ready, found.final)
    one = rubbing(ready, found, weighed, able, left)
    assert one is not None
    assert sorted(one.members) == [0, 1]
    assert one.weighed.chance > NAMED
    assert {one.weighed.cause, *one.weighed.equal} >= {COULOMB, TENSION}
    assert GAIN not in one.weighed.equal
    # one that is certain needs no other, and one alone is no company
    sure = [replace(weighed[0], chance=0.9), *weighed[1:]]
    assert rubbing(ready, found, sure, able, left) is None
    assert rubbing(ready, found, weighed, [0, 2], left) is None
    # where much stays, friction may stand in for something unknown
    much = replace(left, by_channel=dict.fromkeys(left.by_channel, 1e4), whole=1e4)
    assert rubbing(ready, found, weighed, able, much) is None


def test_a_doubted_cause_goes_with_the_named_one_that_it_makes_up_for(alike):
    ready, found = alike
    weighed = list(belief(ready, found).weighed)
    chances = [0.9, 0.2, 0.9]
    judged = [replace(w, chance=c) for w, c in zip(weighed, chances, strict=True)]
    [company] = companies(ready, found, judged, [0, 1, 2], stays(ready, found.final))
    assert sorted(company.members) == [0, 1]
    # two that are named alone are told apart
    judged = [replace(w, chance=0.9) for w in weighed]
    assert companies(ready, found, judged, [0, 1, 2], stays(ready, found.final)) == []


def test_causes_that_act_apart_are_no_company(alike):
    ready, found = alike
    weighed = belief(ready, found).weighed
    for able in ([0, 2], [2], []):
        assert companies(ready, found, weighed, able, stays(ready, found.final)) == []


@pytest.mark.parametrize(('place', 'beside'), [('pulley_2', False), ('pulley_L', True)])
def test_a_motor_is_at_the_place_of_its_pulley(bench, measured_on, place, beside):
    """What the friction's law may leave speaks against a small cause in the motor, too."""
    rubs = (Candidate('coulomb_friction', place), {'torque': 0.05})
    truth = (rubs, (GAIN, {'gain': 1.1}))
    ready, found = ends_with(
        prepared([measured_on(bench, *((c.effect, c.place, v) for c, v in truth))], bench), *truth
    )
    signs = signs_beside(ready.problem, found, found.without[1], stays(ready, found.final))
    assert (signs.beside > 0.0) == beside


def test_what_spoils_nothing_is_kept_though_it_is_not_named(found_of, monkeypatch):
    ready, found = found_of((COULOMB, {'torque': 0.05}), (GAIN, {'gain': 1.1}))
    assert belief(ready, found).accepted == (0, 1)
    monkeypatch.setattr('tendon_ros.diagnose.belief.chance', lambda *_: 0.2)
    doubtful = belief(ready, found)
    assert doubtful.named == {}
    assert doubtful.accepted == ()
    assert doubtful.kept == (0, 1)
    assert doubtful.model(found, doubtful.kept) == found.final.model
    gain = found.without[1]
    monkeypatch.setattr('tendon_ros.diagnose.belief.spoils', lambda _r, _f, fit: fit is gain)
    assert belief(ready, found).kept == (0,)


def test_what_any_effect_does_as_well_is_not_named(found_of):
    ready, found = found_of((COULOMB, {'torque': 0.05}), (GAIN, {'gain': 1.1}))
    frictions = ('stribeck', 'presliding', 'asymmetric', 'tension')
    rivals = [Rival(Candidate(f'{f}_friction', 'pulley_3'), found.final) for f in frictions]
    found.rivals[0] = rivals
    sure = belief(ready, found)
    assert len(sure.weighed[0].equal) == 4
    assert 0 in sure.named
    found.rivals[0] = [*rivals, Rival(Candidate('gravity', 'pulley_3'), found.final)]
    vague = belief(ready, found)
    assert vague.weighed[0].chance <= IDLE < sure.weighed[0].chance
    assert 0 not in vague.named
    assert 1 in vague.named


def test_a_factor_at_its_bound_is_no_cause(found_of):
    """Fifty times too soft or light imitates what no factor tells; it is used for prediction."""
    ready, found = found_of((COULOMB, {'torque': 0.05}), (GAIN, {'gain': 1.1}))
    chances = []
    for gain in (1.1, 0.021, 0.025):
        model = found.final.model.without(1).joined(GAIN, {'gain': gain})
        ended = replace(found, states=[found.start, replace(found.final, model=model)])
        chances.append(belief(ready, ended).weighed[1].chance)
    assert chances[0] > IDLE >= max(chances[1:])
    assert not spent(COULOMB, {'torque': 1e5})


@pytest.mark.parametrize(
    ('cause', 'values', 'far'),
    [
        (Candidate('encoder_gain', 'encoder_M'), {'gain': 1.4}, True),
        (Candidate('encoder_gain', 'encoder_M'), {'gain': 1.2}, False),
        (Candidate('inertia', 'pulley_M'), {'scale': 0.2}, True),
        # something may have been mounted on it
        (Candidate('inertia', 'pulley_M'), {'scale': 6.0}, False),
    ],
)
def test_what_is_further_off_than_any_is_has_to_explain_most(found_of, cause, values, far):
    """A stop takes the torque that an inertia needs; a wrong unit is behind all of a gap."""
    ready, found = found_of((cause, values))
    problem = ready.problem
    found.states[-1] = replace(found.final, model=problem.empty.joined(cause, values))
    assert not _open(problem, found, 0)  # without it, all of the gap is left
    found.without[0] = replace(found.start, left=0.3 * found.start.left)
    assert _open(problem, found, 0) is far


def test_a_weight_of_many_times_the_file_is_believed_where_it_leaves_nothing(found_of):
    """A motor that lags is told as a heavy body, too, but not to the noise."""
    heavy = Candidate('inertia', 'pulley_M')
    ready, found = found_of((heavy, {'scale': 1.2}))
    problem = ready.problem
    left = found.start.left
    for scale, part, ends in ((17.0, 0.01, False), (17.0, 0.5, True), (0.05, 0.01, True)):
        model = problem.empty.joined(heavy, {'scale': scale})
        found.states[-1] = replace(found.final, model=model, left=part * left)
        found.without[0] = replace(found.start, left=left)
        assert is_at_end(problem, found, 0) is ends
        if not ends:
            assert not _open(problem, found, 0)


def test_others_are_judged_without_what_is_at_its_bound(found_of, monkeypatch):
    """It stands for something unknown, and so may they that need it."""
    monkeypatch.setattr('tendon_ros.diagnose.belief.STEADY', 0.0)
    ready, found = found_of((COULOMB, {'torque': 0.1}), (GAIN, {'gain': 1.1}))
    chances = []
    for gain in (1.1, 0.021):
        model = found.final.model.without(1).joined(GAIN, {'gain': gain})
        ended = replace(found, states=[found.start, replace(found.final, model=model)])
        chances.append(belief(ready, ended).weighed[0].chance)
    assert chances[0] > NAMED > chances[1]


def test_what_many_do_nearly_as_well_beside_a_strong_law_is_named(found_of, monkeypatch):
    """Laws may be wrong by more than a noise power; a whole kind is vague only where it ties."""
    ready, found = found_of((COULOMB, {'torque': 0.05}), (GAIN, {'gain': 1.1}))
    monkeypatch.setattr('tendon_ros.diagnose.judge.form_power', lambda *_: 100.0)
    kinds = ('stribeck_friction', 'presliding_friction', 'asymmetric_friction', 'gravity')
    for further, named in ((1.0, True), (0.001, False)):
        cost = found.final.cost + further * len(found.final.left)
        other = replace(found.final, cost=cost)
        found.rivals[0] = [Rival(Candidate(k, 'pulley_3'), other) for k in kinds]
        found.rivals[0].append(Rival(Candidate('joint_spring', 'pulley_3'), other))
        judged = belief(ready, found)
        assert len(judged.weighed[0].equal) == 5
        assert (0 in judged.named) == named


def test_a_preload_that_others_hide_within_their_tolerances_is_found(bench, measured_on):
    # three cables in series: each a little looser does what one much looser does
    press = {'trajectory': 'paper_fig12', 'settings': (), 'touching': True}
    run = measured_on(
        bench, ('pretension', 'cable_m1', {'scale': 0.87}), without=('pulley/',), **press
    )
    problem = prepared([run], bench).problem
    state = problem.fitted(problem.empty)
    suspect = Candidate('pretension', 'cable_m1')
    screen = Screen(problem, state)
    assert screen.suspects(suspect)
    assert not screen.suspects(COULOMB)
    [first] = screen.proposals(suspect)
    # what it costs to hold the others within counts as well
    assert screen.corrected(first).gain > max(2.0 * first.gain, 0.03 * len(state.left))
    asked = [Candidate('pretension', f'cable_{n}') for n in ('m1', '12', 'L3')]
    found = Search(problem, [*asked, Candidate('inertia', 'pulley_3')], jobs=1).run()
    [cause] = found.final.model.causes
    assert cause in asked
    others = {r.candidate for r in equals(problem, found, 0)}
    assert suspect in {cause, *others}
    assert found.final.model.values(0)['scale'] == pytest.approx(0.87, abs=0.02)


def test_what_is_doubted_is_in_the_instrument_and_said_apart(bench, measured_on, monkeypatch):
    run = measured_on(bench, ('torque_gain', 'motor_L', {'gain': 1.1}))
    monkeypatch.setattr('tendon_ros.diagnose.belief.chance', lambda *_: 0.2)
    monkeypatch.setattr('tendon_ros.diagnose.session.next_experiments', lambda *_: ())
    every = {c.effect for c in everyone(bench, sorted(run.channels), ())}
    said = session.diagnose([run], bench, withhold=sorted(every - {'torque_gain'}))
    assert said.diagnosis.causes == ()
    assert said.diagnosis.verdict == 'unexplained'
    [beside] = said.diagnosis.beside
    assert (beside.effect, beside.place, beside.probability) == ('torque_gain', 'motor_L', 0.2)
    assert [(e.effect, e.place) for e in said.instrument.effects] == [('torque_gain', 'motor_L')]
    worst = said.diagnosis.gap[0]
    assert worst.after < 0.3 * worst.before


@pytest.mark.parametrize(
    ('three', 'members'), [(20.0, (0, 1, 2)), (13.0, (0, 1)), (math.inf, (0, 1))]
)
def test_who_makes_up_for_a_company_joins_it(three, members):
    """Apart it is missed by 5 and 2: together with the third it has to be by more than 14."""

    costs = {(0, 1): 5.0, (0, 1, 2): three, (0, 1, 3): 8.0, (0, 1, 2, 3): 21.0}

    class Costs:
        def together(self, members):
            return costs[members]

        def more(self, members, apart):
            return costs[members] - MAKES_UP * apart

    assert _grown(Costs(), (0, 1), {2, 3}, {2: 2.0, 3: 1.0}) == members


def test_what_is_as_large_without_what_undoes_each_other_is_not_doubted_for_it(
    found_of, monkeypatch
):
    """What they stand for is unknown, but it is not this."""
    ready, found = found_of((COULOMB, {'torque': 0.1}), (GAIN, {'gain': 1.1}))
    monkeypatch.setattr('tendon_ros.diagnose.belief.undoing', lambda *_: frozenset({1}))
    firm = belief(ready, found)
    assert [w.chance > NAMED for w in firm.weighed] == [True, False]
    monkeypatch.setattr('tendon_ros.diagnose.belief.STEADY', 0.0)
    assert belief(ready, found).weighed[0].signs.left > firm.weighed[0].signs.left


def test_what_is_missed_but_may_as_well_have_no_size_is_used_and_not_named(found_of, monkeypatch):
    ready, found = found_of((COULOMB, {'torque': 0.05}), (GAIN, {'gain': 1.1}))
    assert belief(ready, found).weighed[1].chance > NAMED
    monkeypatch.setattr('tendon_ros.diagnose.belief.unsized', lambda *_: frozenset({1}))
    judged = belief(ready, found)
    assert judged.weighed[1].chance <= IDLE
    assert judged.accepted == (0,)
    assert judged.kept == (0, 1)


def test_a_push_that_stands_out_only_beside_what_is_not_believed_is_none(measured_on):
    body = load_instrument('single_body')
    rubs = ('coulomb_friction', 'pulley_body', {'torque': 0.2})
    push = ('disturbance', 'pulley_body', {'torque': 0.05, 'start': 4.0, 'duration': 0.6})
    run = measured_on(body, rubs, push, settings=(('duration', '8 s'), ('amplitude', '40 deg')))
    ready, found = ends_with(
        prepared([run], body), *((Candidate(*cause[:2]), cause[2]) for cause in (rubs, push))
    )
    friction, pushed = belief(ready, found).weighed
    assert pushed.signs.lone
    assert pushed.chance > NAMED
    doubted = replace(friction, chance=IDLE), pushed
    assert [w.chance for w in _happening(ready, found, doubted, ())] == [IDLE, IDLE]
    # one that is believed, alone or with others
    assert _happening(ready, found, (friction, pushed), ()) == (friction, pushed)
    assert _happening(ready, found, doubted, (0,)) == doubted


@pytest.mark.parametrize(('inertia', 'kept'), [(1.5, True), (12.0, False)])
def test_what_is_further_off_than_any_is_stays_out_of_the_repaired_file(
    found_of, monkeypatch, inertia, kept
):
    ready, found = found_of((Candidate('inertia', 'pulley_M'), {'scale': 1.2}))
    monkeypatch.setattr('tendon_ros.diagnose.belief.chance', lambda *_: 0.2)
    monkeypatch.setattr('tendon_ros.diagnose.belief.spoils', lambda *_: False)
    monkeypatch.setattr('tendon_ros.diagnose.belief.takes_noise', lambda *_: False)
    final = found.final.model
    place = final.causes[0].coordinates.place({'scale': inertia})
    found.states[-1] = replace(found.final, model=replace(final, z=(place,)))
    judged = belief(ready, found)
    assert judged.accepted == ()
    assert judged.kept == ((0,) if kept else ())
