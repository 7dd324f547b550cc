"""Every candidate is told with its probability, and why it could not have been seen."""

from types import SimpleNamespace

from tendon_ros.diagnose.naming import causes_of, judged, strained, Weighed
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.diagnose.result import Cause, Shrink
from tendon_ros.diagnose.signs import Signs
from tendon_ros.identify.candidate import Candidate
from tendon_ros.model.instrument_file import load_instrument

LATE = Candidate('sensor_delay', 'torque_body')
HEAVY = Candidate('inertia', 'pulley_body')


def test_what_is_named_was_seen_whatever_trace_it_left_at_first():
    silent = [SimpleNamespace(candidate=c, seen=1.0, own=1.0) for c in (LATE, HEAVY)]
    final = SimpleNamespace(model=SimpleNamespace(causes=[LATE]))
    found = SimpleNamespace(final=final, proposals=silent)
    named = Cause(
        effect=LATE.effect,
        place=LATE.place,
        probability=0.9,
        parameters={},
        indistinguishable=(),
        shrink=Shrink(channel='c', unit='N m', before=2.0, without_this=2.0, after=1.0),
    )
    late, heavy = judged(found, [named], [0.9], [LATE, HEAVY], {})
    assert (late.effect, late.identifiable, late.why_not) == ('sensor_delay', True, '')
    assert (heavy.effect, heavy.identifiable) == ('inertia', False)


def test_a_candidate_whose_number_has_moved_far_may_hide_in_it():
    seen = [SimpleNamespace(candidate=c, seen=100.0, own=90.0) for c in (LATE, HEAVY)]
    final = SimpleNamespace(model=SimpleNamespace(causes=[]))
    found = SimpleNamespace(final=final, proposals=seen)
    rows = judged(found, [], [], [LATE, HEAVY], {('inertia', 'pulley_body'): 2.7})
    by_name = {row.effect: row for row in rows}
    assert by_name['sensor_delay'].identifiable
    assert 'has moved by 2.7 deviations' in by_name['inertia'].why_not


def test_only_what_was_measured_is_strained():
    known, guess, near = (
        SimpleNamespace(
            effect=name, place='pulley_body', guessed=name == 'gravity', parameter=parameter
        )
        for name, parameter in (
            ('inertia', 'scale'),
            ('gravity', 'torque'),
            ('viscous_friction', 'damping'),
        )
    )
    # which a cause cannot be
    wall = SimpleNamespace(
        effect='contact_stiffness', place='contact', guessed=False, parameter='damping'
    )
    moved = [(known, -2.5), (guess, 9.0), (near, 1.5), (wall, 3.0), (known, 2.2)]
    problem = SimpleNamespace(moved=lambda _: moved)
    assert strained(problem, None) == {('inertia', 'pulley_body'): 2.5}


def test_a_push_is_not_told_from_others_by_its_own_name(measured_on):
    push = Candidate('disturbance', 'pulley_body')
    pushed = {'torque': 0.3, 'start': 2.0, 'duration': 0.5}
    body = load_instrument('single_body')
    ready = prepared([measured_on(body, (push.effect, push.place, pushed))], body)
    start = ready.problem.fitted(ready.problem.empty, rounds=1)
    final = ready.problem.fitted(ready.problem.empty.joined(push, pushed), rounds=1)
    again = Candidate('disturbance', 'pulley_body', only='free')
    signs = Signs(1.0, left=0.0, form=0.0)
    weighed = Weighed(push, equal=(again, HEAVY), signs=signs, chance=0.9, without=start)
    [cause] = causes_of(ready, start, final, [weighed])
    assert [(o.effect, o.place) for o in cause.indistinguishable] == [(HEAVY.effect, HEAVY.place)]


def test_no_ripple_is_excluded_where_the_angle_drifts():
    ripple = Candidate('torque_ripple', 'motor_body')
    seen = [SimpleNamespace(candidate=c, seen=100.0, own=90.0) for c in (ripple, HEAVY)]
    final = SimpleNamespace(model=SimpleNamespace(causes=[]))
    found = SimpleNamespace(final=final, proposals=seen)
    rows = judged(found, [], [], [ripple, HEAVY], {}, adrift=['motor_body'])
    [said] = [row for row in rows if row.effect == 'torque_ripple']
    assert not said.identifiable
    assert said.why_not.startswith('the angle was not recorded, and that of the model drifts')
    [other] = [row for row in rows if row.effect == 'inertia']
    assert 'the angle' not in other.why_not
