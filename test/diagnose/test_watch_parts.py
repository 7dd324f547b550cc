"""The parts of the watch: when a gap counts as grown, what it is measured against."""

from dataclasses import replace
import math

import numpy as np
import pytest

from tendon_ros.base.errors import RecordingError
from tendon_ros.diagnose.result import ChannelGap, Diagnosis, Unexplained
from tendon_ros.diagnose.watch_cause import as_lasting, places_of, Suspect
from tendon_ros.diagnose.watch_gap import gap_after, GapJudge
from tendon_ros.diagnose.watch_stream import Streams
from tendon_ros.estimate.observer import Measurement
from tendon_ros.model.instrument import EffectUse
from tendon_ros.model.instrument_file import load_instrument


def states(judge, gaps, floor=0.1):
    return [judge.take(gap, floor).grown for gap in gaps]


def test_one_look_neither_raises_nor_lowers():
    judge = GapJudge('load_cell/force', 'N', 2.0, 1.0, 0)
    assert states(judge, [1.9, 2.1, 1.9, 2.1, 2.1]) == [False, False, False, False, True]
    assert states(judge, [1.7, 1.5, 1.5, 2.1]) == [True, True, True, True]
    assert states(judge, [1.5, 1.5, 1.5, 1.9]) == [True, True, False, False]


def test_the_largest_gap_of_the_first_looks_is_explained():
    judge = GapJudge('load_cell/force', 'N', 2.0, math.nan, 3)
    first = [judge.take(gap, 0.1) for gap in (0.5, 0.8, 0.6)]
    assert math.isnan(first[1].explained)
    assert first[2].explained == 0.8
    assert states(judge, [1.5, 1.5, 1.7, 1.7]) == [False, False, False, True]


def test_noise_is_never_a_gap():
    judge = GapJudge('load_cell/force', 'N', 2.0, 0.001, 0)
    assert states(judge, [0.19, 0.19, 0.21, 0.21]) == [False, False, False, True]


def test_the_gap_after_a_diagnosis_is_read(tmp_path):
    gap = ChannelGap(
        channel='load_cell/force',
        unit='N',
        before=2.0,
        after=0.3,
        noise_floor=0.2,
        ci95=(0.2, 0.4),
    )
    found = Diagnosis(
        schema=1,
        verdict='explained',
        gap=(gap,),
        where=(),
        causes=(),
        candidates=(),
        unexplained=Unexplained(probability=0.0),
    )
    path = tmp_path / 'diagnosis.json'
    path.write_text(found.model_dump_json(by_alias=True))
    assert gap_after(path) == {'load_cell/force': 0.3}
    path.write_text('{}')
    with pytest.raises(RecordingError, match='is no diagnosis; give'):
        gap_after(path)
    with pytest.raises(RecordingError, match='cannot be read'):
        gap_after(tmp_path / 'absent.json')


def test_a_window_has_the_very_times_of_a_bag():
    streams = Streams(load_instrument('bench_rig'), 1.0)
    epoch_ns, stamps = 1_700_000_000 * 10**9, range(0, 10**8, 100_000)
    for stamp in stamps:
        values = {'actuator/pulley_M/position': 0.1, 'actuator/pulley_L/position': 0.0}
        streams.add(Measurement(epoch_ns + stamp, values))
    window = streams.window(epoch_ns, epoch_ns + 10**9)
    expected = np.array(stamps) / 1e9
    assert np.array_equal(window['actuator/pulley_M/position'].time, expected)


def test_what_happened_in_the_diagnosis_has_happened():
    slip = EffectUse('cable_slip', 'cable_L3', {'jump': 1e-4, 'time': 3.0})
    push = EffectUse('disturbance', 'pulley_2', {'torque': 0.1, 'start': 2.0, 'duration': 1.0})
    friction = EffectUse('coulomb_friction', 'pulley_2', {'torque': 0.1})
    rig = replace(load_instrument('bench_rig'), effects=(slip, push, friction))
    lasting, said = as_lasting(rig)
    past = EffectUse('cable_slip', 'cable_L3', {'jump': 1e-4, 'time': 0.0})
    assert lasting.effects == (past, friction)
    assert ['cable_slip' in said[0], 'disturbance' in said[1]] == [True, True]


def test_places_that_explain_as_much_are_all_named():
    found = [
        Suspect('coulomb_friction', place, share, {'torque': 0.1}, {'torque': 'N m'})
        for place, share in (('pulley_1', 0.8), ('pulley_2', 0.75), ('pulley_3', 0.4))
    ]
    assert places_of(found) == ('pulley_1', 'pulley_2')
    assert str(found[0]) == 'coulomb_friction at pulley_1 (torque 0.1 N m; explains 80%)'
    assert places_of([]) == ()
