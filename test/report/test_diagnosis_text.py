"""The verdict is one sentence with numbers; the terminal gets it with the rest in few lines."""

from dataclasses import replace

import pytest

from tendon_ros.diagnose.result import Candidate as Named
from tendon_ros.diagnose.result import FittedParameter
from tendon_ros.report.diagnosis_sums import overall
from tendon_ros.report.diagnosis_text import summary
from tendon_ros.report.diagnosis_verdict import headline, rest_words, worth

SENTENCES = {
    'no_gap': (
        'No gap: the model predicts all 4 channels to within their noise; the worst, '
        'pulley 3 angle, is off by 1.1 noise deviations.'
    ),
    'one_cause': (
        'The gap of 6.3 noise deviations is explained by tension-proportional friction on '
        'pulley 3 (97 %); it shrinks to 1.1.'
    ),
    'three_causes': (
        'The gap of 5.5 noise deviations is explained by tension-proportional friction on '
        'pulley 3 (97 %), pretension of cable L3 or one of 2 that look the same (91 %) and '
        'Stribeck friction on pulley 1 (78 %); it shrinks to 1.1.'
    ),
    'partly': (
        'Tension-proportional friction on pulley 3 (97 %) and Stribeck friction on pulley 1 '
        '(78 %) explain part of the gap: it shrinks from 19 to 3.3 noise deviations. The rest, '
        'most likely at pulley 2 (fast motion), is of no known cause.'
    ),
    'unexplained': (
        'Nothing in the catalogue explains the gap of 7.6 noise deviations with any certainty. '
        'What acts like friction on pulley 1 shrinks it to 7.3. The largest part lies at pulley 3 '
        '(64 % of the gap, mostly reversal).'
    ),
}


@pytest.mark.parametrize('name', SENTENCES)
def test_headline(case, name):
    assert headline(case(name)[0]).replace('\u00a0', ' ') == SENTENCES[name]


def test_what_is_only_likely_is_said_to_have_its_part_in_the_shrink(case):
    beside = case('unexplained')[0].beside
    for name in ('one_cause', 'partly'):
        with_more = case(name)[0].model_copy(update={'beside': beside})
        assert 'with what is only likely it shrinks' in headline(with_more)
        assert 'only likely' not in headline(case(name)[0])
    assert 'instrument.yaml has it' in ' '.join(summary(case('unexplained')[0]).split())


def test_a_gap_that_guessed_numbers_close_is_said_with_both(case):
    diagnosis, _ = case('no_gap')
    wide = diagnosis.gap[0].model_copy(update={'before': 14.0 * diagnosis.gap[0].noise_floor})
    text = headline(diagnosis.model_copy(update={'gap': (wide, *diagnosis.gap[1:])}))
    assert text.startswith('No gap that has a cause')
    assert 'is off by 14 noise deviations, and by 1' in text.replace('\u00a0', ' ')


def fitted_to(diagnosis, *floors):
    """Return a diagnosis whose numbers alone leave so many noise deviations of the channels."""
    fitted = {
        gap.channel: much * gap.noise_floor
        for gap, much in zip(diagnosis.gap, floors, strict=True)
    }
    return diagnosis.model_copy(update={'fitted': fitted})


def test_what_numbers_alone_do_is_no_merit_of_the_causes(case):
    said = '(1.5 once what is guessed, or within its tolerance, is fitted)'
    for name in ('one_cause', 'partly', 'unexplained'):
        diagnosis = case(name)[0]
        most = len(diagnosis.gap)
        assert said in headline(fitted_to(diagnosis, *[1.5] * most)).replace('\u00a0', ' ')
        # not where little goes by them
        assert 'once what is' not in headline(fitted_to(diagnosis, *[20.0] * most))
    one = case('one_cause')[0]
    table = summary(fitted_to(one, *[1.5] * len(one.gap)))
    [head] = [line for line in table.splitlines() if line.startswith('gap')]
    assert head.index('before') < head.index('fitted') < head.index('after')


def test_what_is_not_certain_and_does_most_is_said_first(case):
    diagnosis = case('unexplained')[0]
    _, after = overall(diagnosis)
    little = fitted_to(diagnosis, *[10.0 * after] * len(diagnosis.gap))
    text = headline(little).replace('\u00a0', ' ')
    assert text.startswith('What acts like friction on pulley 1 shrinks the gap of 7.6 noise')
    assert 'to 7.3, but nothing in the catalogue explains it with any certainty. The' in text


def test_a_gap_that_grows_where_nothing_was_fitted_is_said_to(case):
    diagnosis = case('unexplained')[0]
    gaps = [g.model_copy(update={'before': g.after, 'after': g.before}) for g in diagnosis.gap]
    grown = diagnosis.model_copy(update={'gap': tuple(gaps)})
    assert ' shrinks ' in headline(diagnosis)
    assert ' shrinks ' not in headline(grown)
    assert ' grows ' in headline(grown)


def test_what_numbers_alone_do_as_well_is_not_said_to_shrink_a_gap(case):
    diagnosis = case('unexplained')[0]
    fitted = {g.channel: 0.9 * g.after for g in diagnosis.gap}
    assert ' shrinks ' in headline(diagnosis)
    assert ' shrinks ' not in headline(diagnosis.model_copy(update={'fitted': fitted}))


def test_a_gap_without_a_form_does_not_contradict_itself(case):
    diagnosis, _ = case('no_gap')
    floor = diagnosis.gap[0].noise_floor
    loud = diagnosis.gap[0].model_copy(update={'before': 2.4 * floor, 'after': 2.1 * floor})
    text = headline(diagnosis.model_copy(update={'gap': (loud, *diagnosis.gap[1:])}))
    assert text.startswith('No gap that has a form')
    assert 'off by 2.4 noise deviations, 2.1 once' in text.replace('\u00a0', ' ')


def test_doubtful_cause_does_not_explain(case):
    unexplained, _ = case('unexplained')
    doubtful = case('one_cause')[0].causes[0].model_copy(update={'probability': 0.3})
    text = headline(unexplained.model_copy(update={'causes': (doubtful,)}))
    assert 'stays unexplained' in text
    assert 'is explained by' not in text
    assert '30\u00a0%' in text


def test_laws_of_friction_that_may_stand_in_for_another_are_one_friction(case):
    unexplained, _ = case('unexplained')
    [one] = unexplained.beside
    laws = ('coulomb_friction', 'tension_friction', 'stribeck_friction')
    more = [one.model_copy(update={'effect': law, 'place': 'pulley_jaw'}) for law in laws]
    more += [one.model_copy(update={'effect': 'gravity', 'place': f'pulley_{n}'}) for n in (4, 5)]
    text = headline(unexplained.model_copy(update={'beside': (one, *more)}))
    said = (
        'like friction on pulley 1, friction on pulley jaw, gravity on pulley 4 and 1 effect more'
    )
    assert said in text.replace('\u00a0', ' ')


def test_many_causes_stay_a_sentence(case):
    diagnosis, _ = case('three_causes')
    many = diagnosis.model_copy(update={'causes': diagnosis.causes * 3})
    assert 'explained by 9 effects, first of all tension-proportional' in headline(many)
    assert len(summary(many).splitlines()) <= 35


def test_gap_over_all_leaves_out_channels_without_a_floor(case):
    diagnosis, _ = case('one_cause')
    blind = diagnosis.gap[0].model_copy(update={'noise_floor': 0.0})
    both = diagnosis.model_copy(update={'gap': (*diagnosis.gap, blind)})
    assert overall(both) == pytest.approx((6.3, 1.1))
    assert overall(diagnosis.model_copy(update={'gap': (blind,)})) == (0.0, 0.0)
    assert '–' in summary(both)


def test_worth_is_in_the_channel_where_it_shows(case):
    diagnosis, _ = case('one_cause')
    channel, text = worth(diagnosis, diagnosis.causes[0])
    assert channel == 'motor M torque'
    assert text == '39.8 mN·m RMSE without it, 9.13 with it (noise floor 8.30)'
    shrink = diagnosis.causes[0].shrink.model_copy(update={'channel': ''})
    nowhere = diagnosis.causes[0].model_copy(update={'shrink': shrink})
    assert worth(diagnosis, nowhere) == ('', '')


def test_summary_fits_a_terminal(case, any_name):
    diagnosis, _ = case(any_name)
    lines = summary(diagnosis).splitlines()
    assert 5 <= len(lines) <= 25
    assert max(map(len, lines)) <= 96
    assert not any('\u00a0' in line for line in lines)
    said = ' '.join(' '.join(lines).split())
    for cause in diagnosis.causes:
        for name in cause.parameters:
            assert f'{name} ' in said


def test_summary_tells_what_is_left_and_what_is_next(case):
    said = summary(case('partly')[0])
    rest = '88 % that something not named is behind it, most likely at pulley 2, else at'
    assert rest in said.replace('\n        ', ' ')
    assert 'next    move motor L freely' in said
    assert 'record\n          pulley/pulley_1/position' in said
    assert 'note    free: 0.4 s' in said
    assert 'something not named' not in summary(case('no_gap')[0])


def test_a_doubt_comes_right_after_the_verdict(case):
    diagnosis, _ = case('one_cause')
    doubt = 'a torque reaches 28 times what its motor can'
    lines = summary(diagnosis.model_copy(update={'doubts': (doubt,)})).splitlines()
    at = lines.index(f'but     {doubt}')
    assert lines[at + 1].startswith('where')


def test_the_rest_and_its_probability_do_not_contradict_one_another(case):
    diagnosis, _ = case('three_causes')
    assert diagnosis.beside == ()
    for after, probability, said in (
        (3.0, 0.01, 'no more than the laws of the named causes may be wrong by'),
        (1.05, 0.99, 'hardly more than noise, but has a form that noise has not'),
        (3.0, 0.99, ''),
        (1.05, 0.01, ''),
    ):
        gap = tuple(g.model_copy(update={'after': after * g.noise_floor}) for g in diagnosis.gap)
        rest = diagnosis.unexplained.model_copy(update={'probability': probability})
        told = diagnosis.model_copy(update={'gap': gap, 'unexplained': rest})
        assert said in rest_words(told)
        assert bool(said) == bool(rest_words(told))
        assert said in ' '.join(summary(told).split())
    # where nothing is named there are no laws that may be wrong
    far = tuple(g.model_copy(update={'after': 3.0 * g.noise_floor}) for g in diagnosis.gap)
    assert rest_words(told.model_copy(update={'gap': far})) != ''
    assert rest_words(told.model_copy(update={'gap': far, 'causes': ()})) == ''


def test_guesses_are_told_with_what_became_of_them(case):
    diagnosis, evidence = case('three_causes')
    [inertia, *_] = evidence.moved
    text = summary(diagnosis, [replace(inertia, guessed=True), *evidence.moved[1:]])
    assert 'file    inertia of pulley 3 × 1.021 (0.987 … 1.055), a guess' in text
    assert '0.994' not in text
    assert 'a guess' not in summary(diagnosis, evidence.moved)


def test_what_has_taken_up_a_gap_is_told(case):
    diagnosis, evidence = case('no_gap')
    moved = [replace(evidence.moved[0], off=1.4), *evidence.moved[1:]]
    assert 'inertia of pulley 3' not in summary(diagnosis, moved).replace('\u00a0', ' ')
    gaps = [g.model_copy(update={'before': 3.0 * g.noise_floor}) for g in diagnosis.gap]
    wide = diagnosis.model_copy(update={'gap': tuple(gaps)})
    text = summary(wide, moved).replace('\u00a0', ' ')
    assert 'inertia of pulley 3' in text
    assert 'pretension of cable' not in text


def test_guesses_that_may_still_be_anything_are_told_once(case):
    diagnosis, evidence = case('three_causes')
    inertia, preload, _ = evidence.moved
    vague = replace(preload, guessed=True, ci95=(0.0, 50.0))
    guesses = [replace(inertia, guessed=True), vague, replace(vague, place='cable_L3')]
    text = summary(diagnosis, guesses)
    assert 'file    inertia of pulley 3 × 1.021 (0.987 … 1.055), a guess' in text
    assert 'pretension of cable 12, cable L3: a guess of which these recordings tell' in text
    assert 'file    pretension of cable 12' in summary(diagnosis, guesses[1:])


def test_what_was_measured_and_has_moved_far_is_told_first(case):
    diagnosis, evidence = case('three_causes')
    inertia, preload, *_ = evidence.moved
    told = summary(diagnosis, [replace(inertia, guessed=True), replace(preload, off=2.7)])
    assert 'file    pretension of cable 12 × 0.994 (0.981 … 1.007), 2.7 deviations off' in told
    assert 'deviations off' not in summary(diagnosis, [replace(preload, off=1.9)])
    usual = summary(diagnosis, [replace(preload, off=3.0, supposed=True)])
    assert '3.0 usual deviations off' in usual


def test_friction_of_each_direction_is_said_as_two_effects_too(case):
    diagnosis, _ = case('one_cause')
    sizes = {
        name: FittedParameter(value=value, unit='N m', ci95=(0.9 * value, 1.1 * value))
        for name, value in (('forward', 17.0), ('backward', 23.4))
    }
    cause = diagnosis.causes[0].model_copy(
        update={'effect': 'asymmetric_friction', 'parameters': sizes}
    )
    text = ' '.join(summary(diagnosis.model_copy(update={'causes': (cause,)})).split())
    assert (
        'Coulomb friction of 20 N·m and torque bias of 3.2 N·m together would do the same' in text
    )
    both = (('coulomb_friction', 'pulley_3'), ('torque_bias', 'motor_3'))
    same = tuple(Named(effect=effect, place=place) for effect, place in both)
    unsure = cause.model_copy(update={'indistinguishable': same})
    lines = summary(diagnosis.model_copy(update={'causes': (unsure,)}))
    assert max(map(len, lines.splitlines())) <= 96
    text = ' '.join(lines.split())
    assert 'together do the same, and these channels cannot tell' in text
    assert 'cannot tell it from' not in text  # neither of them alone


def test_two_effects_that_one_alone_would_do_are_said_to(case):
    diagnosis, _ = case('one_cause')
    whole = Named(effect='asymmetric_friction', place='pulley_3')
    two = tuple(
        diagnosis.causes[0].model_copy(
            update={'effect': effect, 'place': place, 'indistinguishable': (whole,)}
        )
        for effect, place in (('coulomb_friction', 'pulley_3'), ('torque_bias', 'motor_3'))
    )
    told = ' '.join(summary(diagnosis.model_copy(update={'causes': two})).split())
    friction = 'asymmetric friction on pulley 3 alone does'
    assert f'with torque bias of motor 3 it does what {friction}' in told
    assert f'with Coulomb friction on pulley 3 it does what {friction}' in told
    one = ' '.join(summary(diagnosis.model_copy(update={'causes': two[:1]})).split())
    assert friction not in one
