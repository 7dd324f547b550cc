"""Topics ↔ channels, and which instrument a bag holds."""

from hypothesis import given
from hypothesis import strategies as st
import pytest

from tendon_ros.bags.topics import (
    clean_namespace,
    full_topic,
    joint_channel,
    JOINT_FIELDS,
    JOINT_TOPICS,
    namespace_of,
    place_of,
    WRENCH_TOPICS,
)
from tendon_ros.base.errors import RecordingError
from tendon_ros.base.recording import FIELD_UNITS

JOINTS = st.from_regex(r'[a-z][a-zA-Z0-9_]{0,12}', fullmatch=True)


@given(st.sampled_from(sorted(JOINT_TOPICS)), JOINTS, st.sampled_from(JOINT_FIELDS))
def test_joint_channels_lead_back_to_their_topic(topic, joint, field):
    name = joint_channel(topic, joint, field)
    assert place_of(name) == (topic, joint, field)
    assert name.rsplit('/', 1)[-1] in FIELD_UNITS


def test_wrench_channels_lead_back_to_their_topic():
    for topic, (force, torque) in WRENCH_TOPICS.items():
        assert place_of(force) == (topic, '', 'force')
        assert place_of(torque) == (topic, '', 'torque')


def test_the_contract_names():
    assert (
        joint_channel('actuator/measured_js', 'pulley_M', 'effort') == 'actuator/pulley_M/effort'
    )
    assert place_of('setpoint/pulley_L/position')[0] == 'actuator/setpoint_js'
    assert place_of('pulley/pulley_1/position')[0] == 'pulley/measured_js'
    assert place_of('load_cell/force')[0] == 'load_cell/body/measured_cf'
    assert place_of('estimate/torque')[0] == 'body/measured_cf'
    assert place_of('estimate/pulley_3/velocity')[0] == 'pulley/estimated_js'


@pytest.mark.parametrize(
    'name', ['motor/M/position', 'actuator/position', 'actuator/M/current', '', 'load_cell/power']
)
def test_a_channel_without_a_topic_is_refused_with_what_exists(name):
    with pytest.raises(RecordingError, match='GROUP/JOINT/FIELD'):
        place_of(name)


@pytest.mark.parametrize(
    ('written', 'clean'),
    [('instrument', '/instrument'), ('/a/b/', '/a/b'), ('/', ''), ('', '')],
)
def test_namespaces_however_written(written, clean):
    assert clean_namespace(written) == clean
    assert full_topic(written, 'x/y') == f'{clean}/x/y'


def test_the_only_instrument_is_found_in_any_namespace():
    for namespace in ('', '/instrument', '/or/left/tool'):
        topics = [f'{namespace}/actuator/measured_js', f'{namespace}/body/measured_cf', '/rosout']
        assert namespace_of('bag', topics) == namespace


def test_several_instruments_are_named():
    topics = ['/left/actuator/measured_js', '/right/actuator/measured_js']
    with pytest.raises(RecordingError, match=r'/left, /right.*--namespace'):
        namespace_of('bag', topics)
    assert namespace_of('bag', topics, 'right') == '/right'
    with pytest.raises(RecordingError, match=r'/middle/actuator/measured_js.*the bag has /left'):
        namespace_of('bag', topics, 'middle')


def test_a_bag_without_motors_names_what_it_has():
    with pytest.raises(RecordingError, match=r'actuator/measured_js.*the bag has /joint_states'):
        namespace_of('bag', ['/joint_states', '/my_actuator/measured_js'])
