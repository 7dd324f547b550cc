"""Every candidate is told with its probability, and why it could not have been seen."""

from types import SimpleNamespace

from tendon_ros.diagnose.naming import judged, strained
from tendon_ros.diagnose.result import Cause, Shrink
from tendon_ros.identify.candidate import Candidate

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
