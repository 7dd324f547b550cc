"""Whole diagnoses of simulated recordings: what was put in is named, and nothing else."""

import json

import numpy as np
import pytest

from tendon_ros.diagnose.result import Diagnosis
from tendon_ros.effects import find
from tendon_ros.model.instrument_file import load_instrument, save_instrument


def named(outcome):
    return {(c.effect, c.place) for c in outcome.diagnosis.causes}


def alike(cause):
    return {(cause.effect, cause.place)} | {(c.effect, c.place) for c in cause.indistinguishable}


def test_without_an_effect_no_cause(sound_outcome):
    found = sound_outcome.diagnosis
    assert found.verdict == 'no_gap'
    assert not found.causes
    assert found.unexplained.probability < 0.5
    for gap in found.gap:
        assert gap.after < 1.3 * gap.noise_floor


@pytest.mark.parametrize('without', [('pulley/',), ('pulley/', 'load_cell')])
def test_without_an_effect_no_cause_with_fewer_channels(bench, measured_on, quick, without):
    found = quick([measured_on(bench, without=without, seed=4)], bench).diagnosis
    assert found.verdict == 'no_gap'
    assert not found.causes


def test_two_effects_at_once(two_outcome):
    found = two_outcome.diagnosis
    assert found.verdict == 'explained'
    assert len(found.causes) == 2
    for truth in (('coulomb_friction', 'pulley_3'), ('encoder_gain', 'encoder_1')):
        assert any(truth in alike(cause) for cause in found.causes)
    gain = next(c for c in found.causes if c.effect == 'encoder_gain').parameters['gain']
    assert gain.value == pytest.approx(1.03, rel=0.002)
    assert gain.ci95[0] <= 1.03 <= gain.ci95[1]


def test_the_gap_shrinks_to_the_floor_on_data_that_no_fit_has_seen(two_outcome):
    found = two_outcome.diagnosis
    assert found.gap[0].before > 5.0 * found.gap[0].noise_floor
    for gap in found.gap:
        assert gap.after < 1.3 * gap.noise_floor
        assert gap.ci95[0] <= gap.after <= gap.ci95[1]
    for cause in found.causes:
        assert cause.shrink.after < 0.7 * cause.shrink.without_this


def test_what_numbers_alone_close_is_told_from_what_causes_do(two_outcome):
    diagnosis = two_outcome.diagnosis
    assert set(diagnosis.fitted) == {g.channel for g in diagnosis.gap}
    worst = diagnosis.gap[0]
    assert worst.after < 0.7 * diagnosis.fitted[worst.channel]


def test_the_closed_loop_shows_it_too(two_outcome):
    effort = {g.channel: g for g in two_outcome.diagnosis.closed_loop}['actuator/pulley_L/effort']
    assert effort.after < 0.5 * effort.before


def test_where_are_the_places_of_the_causes(two_outcome):
    places = {}
    for spot in two_outcome.diagnosis.where:
        places[spot.place] = places.get(spot.place, 0.0) + spot.share
        assert spot.regime
    assert set(sorted(places, key=lambda p: -places[p])[:2]) == {'pulley_3', 'encoder_1'}
    assert sum(places.values()) <= 1.0 + 1e-6


def test_the_json_is_as_the_contract_says(two_outcome):
    data = json.loads(two_outcome.diagnosis.model_dump_json(by_alias=True))
    assert data['schema'] == 1
    assert {'verdict', 'gap', 'where', 'causes', 'candidates', 'unexplained',
            'next_experiment'} <= set(data)  # fmt: skip
    assert set(data['gap'][0]) == {
        'channel', 'unit', 'before', 'after', 'noise_floor', 'ci95',
    }  # fmt: skip
    assert set(data['where'][0]) == {'place', 'regime', 'share'}
    cause = data['causes'][0]
    assert set(cause) == {
        'effect', 'place', 'probability', 'parameters', 'indistinguishable', 'shrink',
        'recording',
    }  # fmt: skip
    assert {'before', 'without_this', 'after'} <= set(cause['shrink'])
    for parameter in cause['parameters'].values():
        assert set(parameter) == {'value', 'unit', 'ci95'}
        assert parameter['ci95'][0] <= parameter['value'] <= parameter['ci95'][1]
    assert set(data['candidates'][0]) == {
        'effect', 'place', 'probability', 'identifiable', 'why_not',
    }  # fmt: skip
    assert {'probability', 'where', 'regime'} == set(data['unexplained'])
    assert Diagnosis.model_validate(data) == two_outcome.diagnosis


def test_lists_are_sorted_most_first(two_outcome):
    found = two_outcome.diagnosis
    for values in (
        [g.before / g.noise_floor for g in found.gap],
        [w.share for w in found.where],
        [c.probability for c in found.causes],
        [c.probability for c in found.candidates],
    ):
        assert values == sorted(values, reverse=True)


def test_every_candidate_is_judged_and_what_cannot_show_says_why(two_outcome):
    rows = two_outcome.diagnosis.candidates
    assert len({(r.effect, r.place) for r in rows}) == len(rows) > 60
    silent = [r for r in rows if (r.effect, r.place) == ('contact_stiffness', 'contact')]
    assert silent
    assert not silent[0].identifiable
    assert silent[0].why_not
    assert all(bool(r.why_not) != r.identifiable for r in rows)
    for cause in two_outcome.diagnosis.causes:
        assert set(cause.parameters) == {p.name for p in find(cause.effect).parameters}


def test_the_patched_file_loads_and_leaves_no_gap(two_outcome, two_run, tmp_path, quick):
    path = tmp_path / 'instrument.yaml'
    save_instrument(two_outcome.instrument, path)
    again = quick([two_run], load_instrument(str(path)))
    assert again.diagnosis.verdict == 'no_gap', named(again)
    for before, after in zip(
        sorted(two_outcome.diagnosis.gap, key=lambda g: g.channel),
        sorted(again.diagnosis.gap, key=lambda g: g.channel),
        strict=True,
    ):
        assert after.before == pytest.approx(before.after, rel=0.2, abs=0.3 * before.noise_floor)


def test_what_the_report_shows_belongs_to_the_answer(two_outcome):
    evidence = two_outcome.evidence
    assert evidence.recordings == ('free',)
    assert {t.channel for t in evidence.traces} == {g.channel for g in two_outcome.diagnosis.gap}
    for trace in evidence.traces:
        assert 0.1 < np.mean(trace.held_out) < 0.4
    gaps = [step.held_out for step in evidence.steps]
    assert gaps[0] > 2.0 * gaps[-1]
    assert not evidence.steps[0].effect


def test_withheld_is_done_without_and_said(bench, measured_on, quick):
    run = measured_on(
        bench,
        ('torque_ripple', 'motor_L', {'amplitude': 0.1, 'cycles': 60.0, 'phase': 0.5}),
        settings=(('duration', '6 s'), ('amplitude', '10 deg')),
    )
    found = quick([run], bench, withhold=['torque_ripple', 'encoder_gain@encoder_L']).diagnosis
    considered = {(c.effect, c.place) for c in found.candidates}
    assert 'torque_ripple' not in {effect for effect, _ in considered}
    assert ('encoder_gain', 'encoder_L') not in considered
    assert ('encoder_gain', 'encoder_M') in considered
    assert found.verdict in ('unexplained', 'partly_explained')
    assert found.unexplained.probability > 0.5
    share = {}
    for spot in found.where:
        share[spot.place] = share.get(spot.place, 0.0) + spot.share
    assert max(share, key=lambda p: share[p]) in ('motor_L', 'pulley_L', 'torque_L')


def test_a_slip_is_found_with_its_time(bench, measured_on, quick):
    run = measured_on(bench, ('cable_slip', 'cable_12', {'jump': 3e-4, 'time': 3.1}))
    found = quick([run], bench).diagnosis
    [cause] = found.causes
    assert ('cable_slip', 'cable_12') in alike(cause)
    assert cause.parameters['time'].value == pytest.approx(3.1, abs=0.05)
    assert cause.parameters['jump'].value == pytest.approx(3e-4, rel=0.1)


def test_what_motor_signals_cannot_separate_is_not_separated(bench, measured_on, quick):
    run = measured_on(
        bench,
        ('pretension', 'cable_12', {'scale': 0.6}),
        trajectory='paper_fig12',
        settings=(),
        touching=True,
        without=('pulley/', 'load_cell'),
    )
    found = quick([run], bench).diagnosis
    [cause] = found.causes
    assert {('pretension', 'cable_12'), ('pretension', 'cable_m1')} <= alike(cause)
    shared = {(c.effect, c.place): c for c in found.candidates}
    for pair in alike(cause):
        assert not shared[pair].identifiable
        assert shared[pair].probability > 0.0


def test_another_controller_and_sampling_change_nothing(bench, measured_on, quick):
    run = measured_on(bench, ('torque_gain', 'motor_L', {'gain': 0.85}), rate=200.0, seed=9)
    [cause] = quick([run], bench).diagnosis.causes
    assert ('torque_gain', 'motor_L') in alike(cause)


@pytest.mark.parametrize('jobs', [1, 3])
def test_threads_do_not_change_the_answer(measured_on, quick, jobs):
    body = load_instrument('single_body')
    run = measured_on(
        body,
        ('gravity', 'pulley_body', {'torque': 0.3, 'phase': 0.3}),
        settings=(('duration', '6 s'), ('amplitude', '30 deg')),
    )
    one = quick([run], body, jobs=jobs)
    two = quick([run], body, jobs=2)
    assert one.diagnosis == two.diagnosis
