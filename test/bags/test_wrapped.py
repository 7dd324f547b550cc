"""Angles that begin anew each turn, and are imported as the way that was gone."""

import numpy as np
import pytest

from tendon_ros.bags.importing import import_runs
from tendon_ros.bags.mapping import load_mapping
from tendon_ros.base.errors import RecordingError

POSITION = 'actuator/pulley_arm/position'
TIME = np.arange(200) * 0.01
ANGLE = 400.0 * np.sin(3.0 * TIME)  # [deg] more than a turn each way


def recorded(tmp_path, wrap, angle, time=TIME):
    """Return what is imported of angles [deg] as a servo reads them, 0 to 360, by a mapping."""
    return imported(tmp_path, wrap, angle, time)[POSITION]


def imported(tmp_path, wrap, angle, time=TIME):
    """Return the run."""
    rows = [f'{t:.3f},{a}' for t, a in zip(time, angle, strict=True)]
    (tmp_path / 'run.csv').write_text('\n'.join(['t,a', *rows]), encoding='utf-8')
    (tmp_path / 'map.yaml').write_text(
        'format: csv\n'
        'time: {column: t, unit: s}\n'
        f'channels:\n  {POSITION}: {{column: a, unit: deg, sign: -1{wrap}}}\n',
        encoding='utf-8',
    )
    [run] = import_runs(tmp_path / 'run.csv', load_mapping(tmp_path / 'map.yaml'))
    return run


@pytest.mark.parametrize('wrap', ['360 deg', '1 turn', '6.283185307179586 rad'])
def test_an_angle_is_the_way_that_was_gone(tmp_path, wrap):
    found = recorded(tmp_path, f', wrap: {wrap}', np.mod(ANGLE, 360.0))
    assert found.value == pytest.approx(-np.deg2rad(ANGLE))


def test_a_sample_that_lacks_does_not_lose_a_turn(tmp_path):
    read = [f'{a:.6f}' if n % 7 else '' for n, a in enumerate(np.mod(ANGLE, 360.0))]
    found = recorded(tmp_path, ', wrap: 360 deg', read)
    kept = np.arange(ANGLE.size) % 7 > 0
    whole = found.value + np.deg2rad(ANGLE[kept])
    assert np.ptp(whole) < 1e-6


@pytest.mark.parametrize(
    ('wrap', 'words'), [('0 deg', 'more than 0'), ('360', 'has no unit'), ('3 mm', 'wrap')]
)
def test_a_wrap_that_cannot_be_is_one_line(tmp_path, wrap, words):
    with pytest.raises(RecordingError, match=words) as caught:
        recorded(tmp_path, f', wrap: {wrap}', ANGLE)
    assert POSITION in str(caught.value)


def test_rows_that_are_left_out_make_no_turn(tmp_path):
    angle, time = np.mod(ANGLE, 360.0), TIME.copy()
    angle[[50, 90]], time[[50, 90]] = (angle[50] + 170.0, angle[90] - 170.0), 0.0
    kept = np.isin(np.arange(TIME.size), [50, 90], invert=True)
    found = recorded(tmp_path, ', wrap: 360 deg', angle, time)
    assert found.value == pytest.approx(-np.deg2rad(ANGLE[kept]))


def test_behind_a_gear_a_turn_is_less(tmp_path):
    read = np.mod(ANGLE, 360.0)
    found = recorded(tmp_path, ', scale: 0.05, wrap: 360 deg', read)
    assert found.value == pytest.approx(-0.05 * np.deg2rad(ANGLE))
    told = imported(tmp_path, ', wrap: 360 deg', 0.05 * read).warnings
    assert any('give its wrap in the unit of the channel' in text for text in told)


def test_a_motor_that_stood_still_is_told_nothing(tmp_path):
    assert not imported(tmp_path, ', wrap: 360 deg', np.full(TIME.size, 12.0)).warnings
