"""Complaints, losses, CRTK's states, arguments: the parts that need no ROS."""

import pytest

from tendon_ros.nodes.complaints import Complaints
from tendon_ros.nodes.drops import Drops
from tendon_ros.nodes.launcher import split_ros_arguments
from tendon_ros.nodes.operating_state import OperatingState, StateError


def test_complaints_are_said_once_then_counted():
    said = []
    complaints = Complaints(said.append)
    for k in range(1000):
        complaints.add('bad', f'bad {k}', now=k * 0.002)
    assert said == ['bad 0']
    complaints.add('other', 'other', now=2.0)
    complaints.add('bad', 'again', now=6.0)
    assert said == ['bad 0', 'other', 'again (999 more since the last warning)']
    assert complaints.counts() == {'bad': 1001, 'other': 1}
    assert complaints.recent() == 'other'
    assert complaints.recent() == ''


def test_drops_are_gaps_in_the_publishers_count():
    drops = Drops()
    for number in (17, 18, 21, 22, 1, 2, None, 5):
        drops.note('a', number)
    drops.note('b', 40)
    assert drops.lost == {'a': 4}


def test_motion_is_taken_only_where_enabled():
    state = OperatingState(lambda: False)
    state.require_motion()
    state.command('pause')
    with pytest.raises(StateError, match='PAUSED; send state_command resume'):
        state.require_motion()
    state.command('disable')
    with pytest.raises(StateError, match='DISABLED; send state_command enable'):
        state.require_motion()
    state.command('enable')
    state.command('unhome')
    assert not state.is_homed
    with pytest.raises(StateError, match='there are disable, enable, home'):
        state.command('dance')
    assert state.name == 'ENABLED'


@pytest.mark.parametrize(
    ('before', 'command', 'after'),
    [
        ([], 'enable', 'ENABLED'),
        ([], 'disable', 'DISABLED'),
        ([], 'pause', 'PAUSED'),
        ([], 'resume', None),
        (['disable'], 'enable', 'ENABLED'),
        (['disable'], 'disable', 'DISABLED'),
        (['disable'], 'pause', None),
        (['disable'], 'resume', None),
        (['pause'], 'enable', None),
        (['pause'], 'disable', 'DISABLED'),
        (['pause'], 'pause', 'PAUSED'),
        (['pause'], 'resume', 'ENABLED'),
    ],
)
def test_the_transitions_are_those_of_crtk(before, command, after):
    state = OperatingState(lambda: False)
    for earlier in before:
        state.command(earlier)
    name = state.name
    if after is None:
        with pytest.raises(StateError, match=f'{command!r} does nothing in {name}; send one of'):
            state.command(command)
    else:
        state.command(command)
    assert state.name == (after or name)


def test_only_a_reset_leads_out_of_fault():
    failed = [True]
    state = OperatingState(lambda: failed[0])
    assert state.name == 'FAULT'
    with pytest.raises(StateError, match='reset'):
        state.command('enable')
    with pytest.raises(StateError, match='reset'):
        state.require_motion()
    failed[0] = False
    state.reset()
    state.require_motion()


@pytest.mark.parametrize(
    ('words', 'own', 'ros'),
    [
        ('--rate 5', '--rate 5', ''),
        ('--ros-args -p a:=1', '', '--ros-args -p a:=1'),
        ('--x --ros-args -p a:=1 -- --y', '--x --y', '--ros-args -p a:=1'),
        ('--ros-args -r b:=c --ros-args -p a:=1', '', '--ros-args -r b:=c --ros-args -p a:=1'),
    ],
)
def test_arguments_of_ros_are_told_apart(words, own, ros):
    assert split_ros_arguments(words.split()) == (own.split(), ros.split())
