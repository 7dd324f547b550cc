"""Trajectories: profiles, files, sampling, and what is wrong with them."""

from dataclasses import replace
import math
import pickle

import numpy as np
import pytest

from tendon_ros.base.errors import TrajectoryError
from tendon_ros.model.instrument_file import load_instrument
from tendon_ros.model.session import simulate
from tendon_ros.model.trajectory import check_limits, load_trajectory, Trajectory
from tendon_ros.model.trajectory_choice import chosen_trajectory, profiles, settings

MOTORS = ('M', 'L')
DEGREE = math.pi / 180


@pytest.fixture(scope='module')
def rig():
    return load_instrument('paper_rig')


@pytest.mark.parametrize('name', profiles())
def test_every_profile_is_sound_and_described(name, rig):
    one = chosen_trajectory(name, MOTORS)
    assert one.name == name
    assert one.motors == MOTORS
    np.testing.assert_allclose(one.at(0.0), 0.0, atol=1e-12)
    assert np.abs(one.position['M']).max() > 0.5 * DEGREE
    assert profiles()[name].__doc__
    for default, setting in settings(name).values():
        assert setting.meaning
        if isinstance(default, float):
            assert setting.unit
            assert setting.low <= default <= setting.high
    check_limits(one, rig)


@pytest.mark.parametrize('name', [n for n in profiles() if 'driven' in settings(n)])
def test_driven_says_who_moves(name):
    one = chosen_trajectory(name, MOTORS, {'driven': 'L'})
    assert np.ptp(one.position['M']) == 0.0
    assert np.ptp(one.position['L']) > 0.0


@pytest.mark.parametrize('name', [n for n in profiles() if 'amplitude' in settings(n)])
def test_amplitude_is_the_largest_angle(name):
    one = chosen_trajectory(name, MOTORS, {'amplitude': '3 deg'})
    assert np.abs(one.position['M']).max() == pytest.approx(3 * DEGREE, rel=1e-2)


def test_paper_profile_holds_its_angles():
    one = chosen_trajectory('paper_fig12', MOTORS)
    held = one.at(np.array([0.5, 3.5, 7.5, 11.5, 16.0])) / DEGREE
    np.testing.assert_allclose(held[:, 0], [0, 5, 7, 5, 4], atol=1e-6)
    np.testing.assert_array_equal(held[:, 1], 0.0)
    sharp = chosen_trajectory('paper_fig12', MOTORS, {'rounding': 0.0}).at(
        np.array([1.5, 5.5, 13.5])
    )
    np.testing.assert_allclose(sharp[:, 0] / DEGREE, [2.5, 6.0, 4.5])


def test_paper_profile_is_that_of_the_practice_bench(practice):
    from tendon_ros.bags.reader import read_recording

    bag = read_recording(practice / 'case_00' / 'contact')
    setpoint = bag['setpoint/pulley_M/position']
    ours = chosen_trajectory('paper_fig12', MOTORS).at(setpoint.time)[:, 0]
    np.testing.assert_allclose(ours, setpoint.value, atol=0.01 * DEGREE)


def test_step_is_done_within_a_millisecond():
    one = chosen_trajectory('step', MOTORS, {'start': '0.2 s', 'amplitude': '6 deg'})
    ticks = one.sample(1e-3)[:, 0] / DEGREE
    np.testing.assert_allclose(ticks[[0, 200, 201, 3000]], [0, 0, 6, 6])


def test_ramp_goes_at_its_speed():
    one = chosen_trajectory('ramp', MOTORS, {'speed': '2 deg/s', 'amplitude': '-4 deg'})
    np.testing.assert_allclose(one.at(np.array([0.5, 1.5, 2.5]))[:, 0] / DEGREE, [0, -2, -4])


def test_minimum_jerk_starts_and_ends_at_rest():
    one = chosen_trajectory(
        'minimum_jerk', MOTORS, {'move': '2 s', 'start': '0.5 s', 'duration': '4 s'}
    )
    q = one.sample(1e-3)[:, 0]
    speed = np.diff(q) / 1e-3
    assert np.abs(speed[[499, 500, 2499, 2500]]).max() < 1e-4 * np.abs(speed).max()
    assert np.abs(speed).max() == pytest.approx(1.875 * 5 * DEGREE / 2, rel=1e-3)


def test_chirp_goes_from_first_to_last():
    one = chosen_trajectory('chirp', MOTORS, {'first': '1 Hz', 'last': '4 Hz', 'duration': '20 s'})
    crossings = one.time[1:][np.diff(np.sign(one.position['M'])) != 0]
    half = np.diff(crossings)
    assert 0.5 / half[2] == pytest.approx(1.0, rel=0.15)
    assert 0.5 / half[-3] == pytest.approx(4.0, rel=0.1)
    same = chosen_trajectory('chirp', MOTORS, {'first': '2 Hz', 'last': '2 Hz'})
    sine = chosen_trajectory(
        'sine', MOTORS, {'frequency': '2 Hz', 'amplitude': '2 deg', 'duration': '20 s'}
    )
    np.testing.assert_allclose(same.position['M'], sine.position['M'], atol=1e-9)


def test_multisine_has_its_frequencies_and_its_seed():
    given = {'frequencies': '0.5 Hz, 2 Hz', 'duration': '40 s', 'fade': '0 s'}
    one = chosen_trajectory('multisine', MOTORS, given)
    power = np.abs(np.fft.rfft(one.position['M'][:-1]))
    frequency = np.fft.rfftfreq(one.time.size - 1, 1e-3)
    assert set(frequency[np.argsort(power)[-2:]]) == {0.5, 2.0}
    again = chosen_trajectory('multisine', MOTORS, given)
    other = chosen_trajectory('multisine', MOTORS, {**given, 'seed': 1})
    np.testing.assert_array_equal(one.position['L'], again.position['L'])
    assert np.abs(one.position['L'] - other.position['L']).max() > DEGREE
    assert np.abs(one.position['L'] - one.position['M']).max() > DEGREE


@pytest.mark.parametrize(
    ('name', 'given', 'said'),
    [
        ('stp', {}, "no trajectory 'stp'; give a CSV file or one of chirp"),
        ('step', {'amplitud': 1.0}, "no setting 'amplitud'; it has amplitude"),
        ('step', {'amplitude': '5'}, "step: amplitude: '5' has no unit"),
        ('step', {'amplitude': '400 deg'}, 'out of bounds; give -180 deg to 180 deg'),
        ('step', {'amplitude': math.nan}, 'out of bounds'),
        ('step', {'driven': 'X'}, "step: driven: no motor 'X'; there are L, M"),
        ('multisine', {'seed': '1.5'}, 'no whole number'),
        ('multisine', {'frequencies': '1 Hz, 2'}, "'2' has no unit"),
        ('multisine', {'frequencies': 3.0}, 'no list'),
        ('none.csv', {}, 'none.csv: No such file'),
        ('none.csv', {'start': 1.0}, 'a file takes no settings'),
    ],
)
def test_wrong_settings_are_named(name, given, said):
    with pytest.raises(TrajectoryError) as error:
        chosen_trajectory(name, MOTORS, given)
    assert said in str(error.value)


def test_sampling_and_holding():
    one = Trajectory('t', np.array([0.0, 1.0]), {'M': np.array([0.0, 2.0])})
    np.testing.assert_allclose(one.sample(0.25)[:, 0], [0.0, 0.5, 1.0, 1.5, 2.0])
    assert one.sample(0.3).shape == (4, 1)
    assert one.at(99.0) == [2.0]
    assert one.at(np.array([0.5, 5.0])).tolist() == [[1.0], [2.0]]
    with pytest.raises(ValueError, match='read-only'):
        one.position['M'][0] = 1.0


@pytest.mark.parametrize(
    ('time', 'position', 'said'),
    [
        ([], [], 'is empty'),
        ([0.0, 1.0], [0.0], '1 positions for 2 times'),
        ([0.0, 1.0], [0.0, math.nan], 'M of point 1 is not a finite number'),
        ([0.0, math.inf], [0.0, 0.0], 'time of point 1'),
        ([0.0, 1.0, 1.0], [0.0, 0.0, 0.0], r'time of point 2 \(1 s\) does not come after'),
        ([1.0, 2.0], [0.0, 0.0], 'begins at 1 s'),
    ],
)
def test_malformed_trajectories(time, position, said):
    with pytest.raises(TrajectoryError, match=said):
        Trajectory('t', np.array(time), {'M': np.array(position)})


def test_no_motors_at_all():
    with pytest.raises(TrajectoryError, match='is empty'):
        Trajectory('t', np.zeros(1), {})


def test_limits_name_time_and_value(rig):
    slow = replace(rig, motors=(replace(rig.motors[0], speed_limit=2.0 * DEGREE), *rig.motors[1:]))
    far = chosen_trajectory(
        'ramp', MOTORS, {'amplitude': '60 deg', 'speed': '60 deg/s', 'duration': '5 s'}
    )
    with pytest.raises(TrajectoryError, match=r'M is sent to 1\.0472 rad at 1\.5 s.*position_lim'):
        check_limits(far, rig)
    with pytest.raises(TrajectoryError, match=r'at 0\.0872665 rad/s at 0\.5 s.*speed_limit'):
        check_limits(chosen_trajectory('ramp', MOTORS), slow)
    with pytest.raises(TrajectoryError, match="no motor 'X'; it has L, M"):
        check_limits(chosen_trajectory('step', ('X',)), rig)


def test_csv_in_degrees_and_radians(tmp_path):
    file = tmp_path / 'move.csv'
    file.write_text('time_s, L_deg,M_rad\n10,0,0\n\n11,90,0.5\n')
    one = load_trajectory(file, ('M', 'L'))
    assert one.motors == MOTORS
    assert one.time.tolist() == [0.0, 1.0]
    np.testing.assert_allclose(one.at(1.0), [0.5, math.pi / 2])
    assert chosen_trajectory(str(file), MOTORS).position.keys() == one.position.keys()


def test_motors_without_a_column_stay(tmp_path):
    file = tmp_path / 'move.csv'
    file.write_text('time_s,L_deg\n0,0\n1,1\n')
    np.testing.assert_array_equal(load_trajectory(file, MOTORS).position['M'], 0.0)


@pytest.mark.parametrize(
    ('text', 'said'),
    [
        ('', 'line 1: 0 columns for time'),
        ('time_s,M_rad\n', 'is empty'),
        ('time,M_rad\n0,0\n', "line 1: no column is called 'time'"),
        ('time_s,X_rad\n0,0\n', 'after one of the motors L, M'),
        ('time_s,M_mm\n0,0\n', "'M_mm' has no unit of angle; write M_rad or M_deg"),
        ('time_s,M_rad,M_deg\n0,0,0\n', 'line 1: 2 columns for M'),
        ('time_s,M_rad\n0,0\n1\n', 'line 3: 1 values for 2 columns'),
        ('time_s,M_rad\n0,0\n1,x\n', 'line 3: could not convert'),
        ('time_s,M_rad\n0,0\n1,nan\n', 'M of point 1 is not a finite number'),
        ('time_s,M_rad\n0,0\n1,1\n0.5,2\n', 'does not come after'),
    ],
)
def test_bad_csv_is_named(tmp_path, text, said):
    file = tmp_path / 'move.csv'
    file.write_text(text)
    with pytest.raises(TrajectoryError) as error:
        load_trajectory(file, MOTORS)
    assert str(error.value).startswith(f'{file}: ')
    assert said in str(error.value)


def test_columns_may_have_any_order(rig):
    time = np.linspace(0.0, 0.02, 11)
    moves = {'L': np.zeros(11), 'M': np.linspace(0.0, -0.01, 11)}
    there = simulate(rig, Trajectory('there', time, moves))
    for motor, position in moves.items():
        commanded = there[f'setpoint/pulley_{motor}/position'].value
        assert commanded[-1] == pytest.approx(position[-1])


def test_a_motor_without_positions_is_named(rig):
    only = Trajectory('only', np.arange(2.0), {'M': np.zeros(2)})
    with pytest.raises(TrajectoryError, match='has positions of M, the instrument has'):
        simulate(rig, only)


def test_a_trajectory_travels_to_another_process_unchanged():
    sent = Trajectory('one', np.array([0.0, 1.0]), {'M': np.array([0.0, 0.5])})

    got = pickle.loads(pickle.dumps(sent))

    assert got.name == 'one'
    np.testing.assert_array_equal(got.time, sent.time)
    np.testing.assert_array_equal(got.position['M'], sent.position['M'])
    assert not got.position['M'].flags.writeable
