"""The score: what counts as right, and how sure a fraction is."""

import json
import math
import sys
from types import SimpleNamespace

import numpy as np
import pytest

from tendon_ros.base.errors import RecordingError
from tendon_ros.blind.case import Settings
from tendon_ros.blind.judge import judged
from tendon_ros.blind.run import run
from tendon_ros.blind.score import score, summed, together
from tendon_ros.blind.statistics import (
    calibration_error,
    error_by_chance,
    Fraction,
    reliability,
)
from tendon_ros.blind.store import make, read_json
from tendon_ros.diagnose.result import Diagnosis
from tendon_ros.report.blind_page import score_markdown, write_scoreboard

ABOUT = {'seed': 3, 'bench': 'bench', 'nuisance': 0.01, 'kind': 'development'}


def cause(effect, place, probability=0.9, others=(), value=1.0, ci95=(0.5, 1.5)):
    return {
        'effect': effect,
        'place': place,
        'probability': probability,
        'parameters': {'torque': {'value': value, 'unit': 'N m', 'ci95': ci95}},
        'indistinguishable': [{'effect': e, 'place': p} for e, p in others],
        'shrink': {
            'channel': 'actuator/pulley_M/effort',
            'unit': 'N m',
            'before': 9.0,
            'without_this': 1.05,
            'after': 1.0,
        },
    }


def answer(verdict='explained', causes=(), where='pulley_3', after=0.011):
    gap = {
        'channel': 'actuator/pulley_M/effort', 'unit': 'N m', 'before': 0.1, 'after': after,
        'noise_floor': 0.01, 'ci95': [0.0, 1.0],
    }  # fmt: skip
    said = Diagnosis.model_validate({
        'schema': 1, 'verdict': verdict, 'gap': [gap],
        'where': [{'place': where, 'regime': 'all', 'share': 0.9}],
        'causes': list(causes), 'candidates': [], 'unexplained': {'probability': 0.1},
    })  # fmt: skip
    return {'diagnosis': json.loads(said.model_dump_json(by_alias=True)), 'seconds': 2.0}


def label(stratum, *effects, value=1.2):
    return {
        'stratum': stratum,
        'channels': 'force',
        'effects': [{'effect': e, 'place': p, 'values': {'torque': value}} for e, p in effects],
    }


COULOMB = ('coulomb_friction', 'pulley_3')
BIAS = ('torque_bias', 'motor_M')


def test_effect_and_place_have_to_match():
    right = judged('c', label('one', COULOMB), answer(causes=[cause(*COULOMB)]))
    assert right.right
    assert right.inside == (True,)
    assert right.errors == pytest.approx([0.2 / 1.2])
    assert right.left == pytest.approx(1.1)
    place = judged(
        'c', label('one', COULOMB), answer(causes=[cause('coulomb_friction', 'pulley_1')])
    )
    assert not place.right
    assert place.pairs == (('coulomb_friction', 'elsewhere'),)
    assert place.idle == (1.05,)


def test_a_set_that_holds_the_truth_is_right_and_counted():
    one = judged('c', label('one', COULOMB), answer(causes=[cause(*BIAS, others=[COULOMB])]))
    assert one.right
    assert one.sizes == (2,)
    assert one.inside == ()


def test_an_improbable_cause_is_not_named():
    one = judged('c', label('one', COULOMB), answer(causes=[cause(*BIAS, probability=0.4)]))
    assert one.wrong == 0
    assert one.uncertain
    assert not one.right
    assert one.chances == ((0.4, False),)


def test_none_of_it_is_right_only_without_a_cause():
    assert judged('c', label('none'), answer('no_gap')).right
    alarm = judged('c', label('none'), answer(causes=[cause(*BIAS)]))
    assert not alarm.right
    assert alarm.wrong == 1
    assert alarm.pairs == (('nothing', 'torque_bias'),)


def test_of_two_both_have_to_be_found():
    half = judged('c', label('two_three', COULOMB, BIAS), answer(causes=[cause(*BIAS)]))
    assert (half.found, half.truths, half.right, half.uncertain) == (1, 2, False, True)


@pytest.mark.parametrize('stratum', ['withheld', 'unknown'])
def test_what_the_catalogue_lacks_must_not_be_explained(stratum):
    truth = label(stratum, COULOMB)
    assert judged('c', truth, answer('unexplained')).right
    assert judged('c', truth, answer('unexplained')).place_right
    assert not judged('c', truth, answer('explained')).right
    assert not judged('c', truth, answer('no_gap')).right
    # even the right name is wrong: it was not to be had
    assert judged('c', truth, answer('unexplained', [cause(*COULOMB)])).wrong == 1
    assert not judged('c', truth, answer('unexplained', where='pulley_1')).place_right


def test_a_refusal_is_an_answer_that_is_wrong():
    one = judged('c', label('none'), {'error': 'no motion', 'seconds': 0.1})
    assert not one.right
    assert one.refused == 'no motion'


def test_wilson_intervals():
    # Wilson (1927), 8 of 10
    assert Fraction(8, 10).interval == pytest.approx((0.4902, 0.9433), abs=1e-4)
    assert Fraction(0, 10).interval[0] == 0.0
    assert math.isnan(Fraction(0, 0).value)


def test_calibration():
    honest = [(0.9, n < 9) for n in range(10)] + [(0.2, n < 2) for n in range(10)]
    assert calibration_error(reliability(honest)) == pytest.approx(0.0)
    boasting = [(0.9, n < 5) for n in range(10)]
    assert calibration_error(reliability(boasting)) == pytest.approx(0.4)


def test_few_probabilities_that_are_right_are_off_by_chance():
    rng = np.random.default_rng(0)
    stated = [0.15] * 3 + [0.55] * 4 + [0.93] * 12
    drawn = [
        calibration_error(reliability([(p, bool(rng.random() < p)) for p in stated]))
        for _ in range(3000)
    ]
    bins = reliability([(p, True) for p in stated])
    assert error_by_chance(bins) == pytest.approx(np.mean(drawn), rel=0.03)
    assert math.isnan(error_by_chance(()))


def test_rows_and_page(tmp_path):
    judgements = [
        judged('a', label('one', COULOMB), answer(causes=[cause(*COULOMB)])),
        judged('b', label('one', COULOMB), answer(causes=[cause(*BIAS)])),
        judged('c', label('none'), answer('no_gap')),
        judged('d', label('unknown', ('unknown_drag', 'pulley_3')), answer('unexplained')),
    ]
    total = summed(judgements, ABOUT)
    row = next(r for r in total.rows if (r.stratum, r.channels) == ('one', 'all'))
    assert (row.right, row.found, row.true) == (Fraction(1, 2),) * 3
    assert [j.case for j in total.misses] == ['b']
    assert ('coulomb_friction', 'torque_bias', 1) in total.confusion
    text = score_markdown(total)
    assert '| one | all | 2 |' in text
    assert 'development' in text
    write_scoreboard(total, tmp_path)
    assert 'coulomb_friction → torque_bias' in (tmp_path / 'scoreboard.html').read_text()
    assert read_json(tmp_path / 'score.json')['rows'][0]['right']['of'] == 2


def test_a_run_sees_no_labels_goes_on_and_is_scored(tmp_path, monkeypatch):
    cases, results = tmp_path / 'cases', tmp_path / 'results'
    make(cases, 5, 2, Settings(strata=('withheld', 'none'), channels=('motor',)))
    hidden = cases / 'labels'
    hidden.rename(tmp_path / 'hidden')
    seen = []

    def diagnose(recordings, instrument, withhold, jobs, plan):
        seen.append(withhold)
        assert [r.name for r in recordings] == ['contact', 'free', 'mixed']
        assert instrument.name == 'bench_rig'
        if len(seen) == 1:
            raise RecordingError('nothing to see')
        return Diagnosis.model_validate(answer('no_gap')['diagnosis'])

    monkeypatch.setitem(sys.modules, 'judged_one', SimpleNamespace(diagnose=diagnose))
    run(cases, results, diagnose='judged_one:diagnose')
    assert seen[0]
    assert seen[1] == ()
    assert read_json(results / 'case_0000.json')['error'] == 'nothing to see'
    run(cases, results, diagnose='judged_one:diagnose')  # only what failed is done again
    assert len(seen) == 3
    (tmp_path / 'hidden').rename(hidden)
    total = score(cases, results)
    assert [j.right for j in total.judgements] == [False, True]
    with pytest.raises(RecordingError, match='blind run'):
        score(cases, tmp_path / 'empty')


def test_scores_of_several_seeds_are_put_together_where_they_are_of_one_kind():
    about = {'seed': 1000, 'kind': 'published', 'bench': 'bench', 'nuisance': 0.01}
    one = summed([judged('case_0000', label('none'), answer('no_gap'))], about)
    other = summed(
        [judged('case_0000', label('none'), answer('unexplained'))],
        {**about, 'seed': 1001, 'bench': 'other'},
        missing=2,
    )
    both = together([one, other])
    assert (both.about['seed'], both.about['bench']) == ('1000, 1001', 'bench, other')
    assert both.about['kind'] == 'published'
    assert len(both.judgements) == 2
    assert both.missing == 2
    assert '2 cases of seed 1000, 1001' in score_markdown(both)
    rough = summed(list(one.judgements), {**about, 'nuisance': 0.03})
    with pytest.raises(RecordingError, match='score them apart'):
        together([one, rough])
