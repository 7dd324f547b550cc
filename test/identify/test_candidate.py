"""Candidates: every effect wherever it can act, and nowhere else."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.base.errors import TendonError
from tendon_ros.base.recording import Channel, Recording
from tendon_ros.effects import catalogue, find
from tendon_ros.identify.candidate import (
    Candidate,
    check_withheld,
    everyone,
    starts,
)
from tendon_ros.identify.magnitude import magnitude_of, TYPICAL
from tendon_ros.model.instrument_file import load_instrument
from tendon_ros.model.numbers import place_index


@pytest.fixture(scope='module')
def channels(bench):
    return [s.channel for s in bench.sensors]


def pairs(candidates):
    return {(c.effect, c.place) for c in candidates}


def test_the_whole_catalogue_at_every_place(bench, channels):
    found = pairs(everyone(bench, channels))
    assert {effect for effect, _ in found} == set(catalogue())
    for effect, place in found:
        assert place_index(bench, place)[0] in find(effect).kinds
    for pulley in 'M', 'L', '1', '2', '3':
        assert ('coulomb_friction', f'pulley_{pulley}') in found
    for cable in 'm1', '12', 'L3':
        assert ('pretension', f'cable_{cable}') in found
    assert ('pretension', 'pulley_1') not in found


def test_a_sensor_that_was_not_there_is_not_at_fault(bench, channels):
    silent = [c for c in channels if c != 'load_cell/force']
    missing = pairs(everyone(bench, channels)) - pairs(everyone(bench, silent))
    assert {place for _, place in missing} == {'load_cell'}
    assert ('load_cell_gain', 'load_cell') in missing


def test_withheld_everywhere_or_at_one_place(bench, channels):
    full = pairs(everyone(bench, channels))
    without = pairs(everyone(bench, channels, ['pretension', 'coulomb_friction@pulley_3']))
    assert full - without == {('pretension', f'cable_{c}') for c in ('m1', '12', 'L3')} | {
        ('coulomb_friction', 'pulley_3')
    }


def test_events_have_times_and_what_lasts_has_none():
    push = Candidate('disturbance', 'pulley_2')
    assert push.changes({'torque': 0.3, 'start': 4.0, 'duration': 1.5}) == (4.0, 5.5)
    slip = Candidate('cable_slip', 'cable_L3')
    assert slip.changes({'jump': 2e-4, 'time': 7.0}) == (7.0,)
    assert Candidate('gravity', 'pulley_2').changes({'torque': 0.1, 'phase': 0.0}) == ()


def test_a_pulley_has_no_less_than_no_damping(bench, channels):
    for pulley in bench.pulleys:
        place = f'pulley_{pulley.name}'
        [damping] = next(
            c
            for c in everyone(bench, channels)
            if (c.effect, c.place) == ('viscous_friction', place)
        ).parameters
        assert damping.low == -pulley.damping


def test_sizes_are_as_large_as_the_instrument(bench, sound_run):
    louder = [
        replace(c, value=20.0 * c.value)
        for name, c in sound_run.channels.items()
        if name.endswith('/effort')
    ]
    large = magnitude_of([sound_run.with_channels(louder)], bench)
    assert magnitude_of([sound_run], bench) == TYPICAL
    assert large.force > 1.5
    [one] = [
        c
        for c in everyone(bench, sorted(sound_run.channels), (), large)
        if (c.effect, c.place) == ('stribeck_friction', 'pulley_3')
    ]
    small = replace(one, magnitude=TYPICAL)
    for was, now in zip(small.parameters, one.parameters, strict=True):
        times = large.force if was.unit == 'N m' else 1.0
        assert (now.typical, now.high) == pytest.approx((times * was.typical, times * was.high))


CARRIAGE = """
pulleys:
  left: {inertia: 6e-5 kg*m^2}
  right: {inertia: 6e-5 kg*m^2}
  carriage: {inertia: 1.5 kg*m^2, damping: 4 N*m*s/rad}  # a radian is a metre
  arm: {inertia: 1e-3 kg*m^2}
curves:
  span: {elongation: {mm: [0, 10]}, tension: {N: [0, 300]}}
loops:
  one: {route: {carriage: 1 m, left: -15 mm}, curve: span, pretension: 60 N}
  two: {route: {right: 15 mm, carriage: -1 m}, curve: span, pretension: 60 N}
couplings:
  shaft: {route: {left: 1, arm: -2}, stiffness: 30 N*m/rad}
motors:
  left: {encoder: {counts: 8192}}
  right: {encoder: {counts: 8192}}
control: {rate: 1 kHz}
"""


def test_what_a_motor_moves_by_a_gear_has_larger_forces(tmp_path):
    path = tmp_path / 'carriage.yaml'
    path.write_text(CARRIAGE, encoding='utf-8')
    belt = load_instrument(path)
    frictions = {
        c.place: c.parameters[0]
        for c in everyone(belt, [s.channel for s in belt.sensors])
        if c.effect == 'coulomb_friction'
    }
    usual = Candidate('coulomb_friction', 'pulley_left').parameters[0]
    # twice as fast is no other kind of force
    assert (
        frictions['pulley_left'] == frictions['pulley_right'] == frictions['pulley_arm'] == usual
    )
    assert frictions['pulley_carriage'].typical == pytest.approx(usual.typical / 0.015)
    dampings = {
        c.place: c.parameters[0].typical
        for c in everyone(belt, [s.channel for s in belt.sensors])
        if c.effect == 'viscous_friction'
    }
    assert dampings['pulley_carriage'] == pytest.approx(dampings['pulley_left'] / 0.015**2)


def test_a_strong_and_slow_machine_may_have_much_damping():
    time = np.arange(0.0, 10.0, 0.01)
    axis = load_instrument('single_body')
    angle, effort = (f'actuator/pulley_body/{name}' for name in ('position', 'effort'))
    # a carriage of a hundred kilograms: a metre is a radian
    run = Recording(
        'carriage',
        {
            angle: Channel(angle, time, 0.1 * np.sin(time)),
            effort: Channel(effort, time, 100.0 * np.cos(time)),
        },
    )
    large = magnitude_of([run], axis)
    everything = everyone(axis, [angle, effort], (), large)
    [damping] = next(c for c in everything if c.effect == 'viscous_friction').parameters
    assert large.force == pytest.approx(20.0, rel=0.01)
    assert damping.high > 1000.0, 'all of the torque may be damping'
    # what never moves tells nothing of dampings
    still = Recording('still', {effort: run[effort], angle: Channel(angle, time, 0.0 * time)})
    assert magnitude_of([still], axis).damping == large.force


@pytest.mark.parametrize(
    ('text', 'says'),
    [
        ('coulomb_frictoin', 'coulomb_friction'),
        ('pretension@cable_XX', 'cable_XX'),
        ('pretension@pulley_3', 'cannot act there'),
    ],
)
def test_withholding_what_does_not_exist_is_refused(bench, text, says):
    with pytest.raises(TendonError) as caught:
        check_withheld(bench, [text])
    assert says in str(caught.value)
    assert '\n' not in str(caught.value)


def test_starts_are_possible_values_and_change_something(bench, channels):
    for candidate in everyone(bench, channels):
        rows = starts(candidate)
        assert rows
        for row in rows:
            for p in candidate.parameters:
                assert p.low <= row[p.name] <= p.high
            if candidate.scales:
                assert any(row[p.name] != p.neutral for p in candidate.parameters)


def test_an_event_can_be_of_one_recording():
    slip = Candidate('cable_slip', 'cable_12', only='free')
    assert slip.acts_in('free')
    assert not slip.acts_in('contact')
    assert Candidate('cable_slip', 'cable_12').acts_in('contact')
    assert [p.name for p in slip.instants] == ['time']


def test_what_crosses_may_turn_back_as_much_elsewhere():
    here, there = (Candidate('encoder_offset', f'encoder_{name}') for name in ('M', 'L'))
    assert there.as_much(here, {'angle': -0.02}, back=True) == {'angle': pytest.approx(0.02)}
    # a friction has one sign
    rubs = Candidate('coulomb_friction', 'pulley_2')
    assert rubs.as_much(rubs, {'torque': 0.1}, back=True) == {'torque': pytest.approx(0.1)}


def test_an_effect_of_the_file_begins_from_as_much_more_as_was_found_elsewhere():
    here = Candidate('tension_friction', 'pulley_1', given=(('coefficient', 0.03),))
    there = Candidate('tension_friction', 'pulley_2')
    assert here.as_much(there, {'coefficient': 0.02}) == {'coefficient': pytest.approx(0.05)}
    assert there.as_much(here, {'coefficient': 0.05}) == {'coefficient': pytest.approx(0.02)}
    # within its bounds; and the shape that the file gives stays
    assert here.as_much(there, {'coefficient': 1.0}) == {'coefficient': 1.0}
    file = (('static', 0.1), ('sliding', 0.05), ('speed', 0.3))
    known = Candidate('stribeck_friction', 'pulley_1', given=file)
    found = {'static': 0.02, 'sliding': 0.01, 'speed': 0.1}
    assert known.as_much(Candidate('stribeck_friction', 'pulley_2'), found) == {
        'static': pytest.approx(0.12),
        'sliding': pytest.approx(0.06),
        'speed': 0.3,
    }


def test_only_of_a_sensor_of_speed_a_filter_is_looked_for():
    belt = load_instrument('belt_by_voltage')
    late = {c.place: c for c in everyone(belt, [s.channel for s in belt.sensors])
            if c.effect == 'sensor_delay'}  # fmt: skip
    assert [p.name for p in late.pop('speed_roller').parameters] == ['time', 'filtered']
    assert late
    assert all([p.name for p in one.parameters] == ['time'] for one in late.values())
