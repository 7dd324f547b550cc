"""What the monitor says of a report."""

import math

import pytest

pytest.importorskip('rclpy')

from tendon_ros.diagnose.watch import WatchReport
from tendon_ros.diagnose.watch_cause import Suspect
from tendon_ros.diagnose.watch_gap import WatchedGap
from tendon_ros.nodes.diagnostics import Level
from tendon_ros.nodes.monitor_status import channels, whole

FORCE = WatchedGap('load_cell/force', 'N', 0.6, 0.05, 0.1, 0.2, grown=True)
EFFORT = WatchedGap('actuator/pulley_M/effort', 'N m', 0.01, 0.008, 0.01, 0.02, grown=False)
CAUSE = Suspect('load_cell_gain', 'load_cell', 0.9, {'gain': 1.2}, {'gain': '1'})


def test_nothing_grown_is_ok_whatever_the_state():
    for state in ('waiting', 'resting', 'learning', 'watching'):
        level, text, details = whole(WatchReport(1, state, (EFFORT,)))
        assert level == Level.OK
        assert text
        assert details == {'state': state}


def test_a_grown_gap_is_a_warning_with_place_and_cause():
    report = WatchReport(1, 'watching', (EFFORT, FORCE), {}, ('load_cell',), (CAUSE,))
    level, text, details = whole(report)
    assert level == Level.WARN
    assert text.startswith('load_cell/force: the gap has grown to 0.6 N, 3.0 times')
    assert 'at load_cell, most likely load_cell_gain at load_cell (gain 1.2' in text
    assert details['where'] == 'load_cell'
    assert 'explains 90%' in details['cause 1']


def test_a_fault_is_an_error_even_where_a_gap_has_grown():
    fault = {'load_cell/force': 'load_cell/force: its stamps end'}
    level, text, _ = whole(WatchReport(1, 'watching', (EFFORT, FORCE), fault))
    assert (level, text) == (Level.ERROR, 'load_cell/force: its stamps end')


def test_every_channel_has_a_status():
    learnt = WatchedGap('pulley/pulley_1/position', 'rad', 1e-4, 1e-4, math.nan, math.inf, False)
    silent = {'pulley/pulley_2/position': 'pulley/measured_js: nothing for 2.0 s'}
    report = WatchReport(1, 'watching', (EFFORT, FORCE, learnt))
    message = channels(report, silent, 'instrument/monitor', 5 * 10**9)
    assert message.header.stamp.sec == 5
    found = {status.name.removeprefix('instrument/monitor: '): status for status in message.status}
    levels = {name: status.level for name, status in found.items()}
    assert levels == {
        'actuator/pulley_M/effort': b'\x00',
        'load_cell/force': b'\x01',
        'pulley/pulley_1/position': b'\x00',
        'pulley/pulley_2/position': b'\x02',
    }
    values = {v.key: v.value for v in found['load_cell/force'].values}
    assert values == {
        'gap [N]': '0.6',
        'noise floor [N]': '0.05',
        'unit': 'N',
        'explained [N]': '0.1',
        'limit [N]': '0.2',
    }
    assert found['pulley/pulley_1/position'].message == 'being learnt'
    assert {status.hardware_id for status in message.status} == {'instrument'}
