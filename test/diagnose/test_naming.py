"""Every candidate is told with its probability, and why it could not have been seen."""

from types import SimpleNamespace

from tendon_ros.diagnose.naming import judged
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
    late, heavy = judged(found, [named], [0.9], [LATE, HEAVY])
    assert (late.effect, late.identifiable, late.why_not) == ('sensor_delay', True, '')
    assert (heavy.effect, heavy.identifiable) == ('inertia', False)
