"""The model for prediction has what foretells, believed or not, and names no cause."""

from tendon_ros.diagnose.judge import signs_of
from tendon_ros.diagnose.naming import Weighed
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.diagnose.search import Search
from tendon_ros.diagnose.stand_in import predicting
from tendon_ros.identify.candidate import Candidate
from tendon_ros.model.instrument_file import load_instrument


def test_what_foretells_is_used_for_prediction_and_what_is_believed_is_no_stand_in(measured_on):
    bench = load_instrument('bench_rig')
    ready = prepared(
        [measured_on(bench, ('coulomb_friction', 'pulley_3', {'torque': 0.1}))], bench
    )
    asked = [Candidate('coulomb_friction', 'pulley_3'), Candidate('gravity', 'pulley_2')]
    found = Search(ready.problem, asked, jobs=1).run()
    assert found.final.model.causes == (asked[0],)
    weighed = [Weighed(asked[0], (), signs_of(ready.problem, found, 0))]
    assert predicting(ready, found, weighed, [0], bench) is None
    told = predicting(ready, found, weighed, [], bench)
    assert told is not None
    said, instrument = told
    assert [(c.effect, c.place) for c in said.stand_ins] == [('coulomb_friction', 'pulley_3')]
    assert said.stand_ins[0].parameters['torque'].value > 0.08
    worst = max(said.gap, key=lambda g: g.before / g.noise_floor)
    assert worst.after < 0.3 * worst.before
    assert ('coulomb_friction', 'pulley_3') in {(e.effect, e.place) for e in instrument.effects}
    # what is left beyond noise is stated, for estimates
    assert all(s.misfit < worst.before for s in instrument.sensors)
