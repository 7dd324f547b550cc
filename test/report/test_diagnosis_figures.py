"""Figures show what the numbers say, in the right order, with nothing lost without a word."""

import pytest

from tendon_ros.diagnose.evidence import Step
from tendon_ros.diagnose.result import Where
from tendon_ros.report.diagnosis_figures import (
    cause_bars,
    channel_bars,
    OTHER,
    rival_bars,
    step_bars,
    where_map,
    worth_bars,
)


def test_map_has_each_share_in_its_cell(case):
    where = case('three_causes')[0].where
    figure = where_map(where)
    assert figure.rows[:2] == ('pulley 3', 'cable L3')
    for entry in where:
        row = figure.rows.index(entry.place.replace('_', ' '))
        column = figure.columns.index(entry.regime)
        assert figure.values[row][column] == pytest.approx(entry.share)
    assert figure.texts[0][figure.columns.index('contact')] == ''
    assert figure.ends[0] == '64\u00a0%'
    assert float(figure.shade(0.38)) > float(figure.shade(0.21)) > float(figure.shade(0.0)) == 0.0


def test_map_sums_up_what_has_no_room():
    where = [
        Where(place=f'pulley_{k}', regime=f'regime {k}', share=(20 - k) / 210) for k in range(20)
    ]
    figure = where_map(where)
    assert len(figure.rows) == 10
    assert len(figure.columns) == 6
    assert figure.rows[-1] == figure.columns[-1] == OTHER
    total = sum(sum(row) for row in figure.values)
    assert total == pytest.approx(sum(w.share for w in where))


def test_map_of_overlapping_regimes_has_no_sums():
    where = [Where(place='pulley_1', regime=regime, share=0.8) for regime in ('a', 'b')]
    assert where_map(where).ends == ()


def test_causes_come_first_and_their_equals_are_no_rivals(case):
    diagnosis, _ = case('three_causes')
    bars = cause_bars(diagnosis).rows
    assert [bar.tone for bar in bars] == ['after'] * 3 + ['pale'] * 4 + ['bad']
    assert bars[1].note == 'Cannot be told from pretension of cable 12 and cable L3 stiffness.'
    assert bars[-1].label == 'None of these'
    assert bars[-1].value == diagnosis.unexplained.probability


def test_channels_are_shown_the_worst_first_with_their_floor(case):
    diagnosis, _ = case('three_causes')
    figure = channel_bars(diagnosis.gap[::-1], 'title')
    assert [bar.text for bar in figure.rows] == [
        '7.9 → 1.1',
        '6.1 → 1.1',
        '4.4 → 1.1',
        '1.9 → 1.0',
    ]
    assert figure.rows[0].note == '65.6 → 9.30 mN·m RMSE, noise floor 8.30 mN·m'
    assert all(bar.level == 1.0 for bar in figure.rows)
    assert figure.full == pytest.approx(7.9)


def test_channel_without_a_floor_is_compared_with_itself(case):
    figure = channel_bars(case('three_causes')[0].closed_loop, 'title')
    bar = next(bar for bar in figure.rows if bar.label == 'motor L angle')
    assert bar.level is None
    assert bar.text == '2.56 → 0.220\u00a0mrad'
    assert bar.note == 'RMSE; no noise floor is known'
    assert bar.value / bar.behind == pytest.approx(0.00022 / 0.00256)


def test_steps_name_what_joined(case):
    figure = step_bars(case('three_causes')[1].steps)
    assert [bar.label for bar in figure.rows] == [
        'instrument file, numbers within tolerances',
        '+ tension-proportional friction on pulley 3',
        '+ pretension of cable L3 and Stribeck friction on pulley 1',
        'fitted again',
    ]
    assert [bar.value for bar in figure.rows] == [6.3, 2.6, 1.12, 1.1]
    assert step_bars((Step('', '', 0.9, 0.8),)).full == pytest.approx(1.2)


def test_worth_compares_without_and_with(case):
    figure = worth_bars(case('three_causes')[0])
    assert [bar.text for bar in figure.rows] == ['4.8', '2.2', '1.6']
    assert figure.rows[0].behind == pytest.approx(4.8)
    assert all(bar.value == pytest.approx(1.1) for bar in figure.rows)


def test_rivals_are_the_best_and_say_of_how_many(case):
    rivals = case('three_causes')[1].rivals
    figure = rival_bars(rivals, {('tension_friction', 'pulley_3')}, 5)
    assert len(figure.rows) == 5
    assert [bar.value for bar in figure.rows] == sorted((r.share for r in rivals), reverse=True)[
        :5
    ]
    assert [bar.tone for bar in figure.rows] == ['after'] + ['pale'] * 4
    assert figure.caption.endswith(f'The best 5 of {len(rivals)}.')


def test_parts_stay_within_the_scale(case):
    figure = channel_bars(case('unexplained')[0].gap, 'title')
    assert figure.part(0.0) == figure.part(-1.0) == '0.00%'
    assert figure.part(2.0 * figure.full) == '100.00%'
