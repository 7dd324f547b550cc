"""A channel that stops is told from a topic that stops."""

import math

from tendon_ros.nodes.arrivals import Arrivals

MOTOR = ('actuator/pulley_M/position', 'actuator/pulley_M/effort')
FORCE = 'load_cell/force'


def test_a_topic_is_silent_where_nothing_of_it_comes():
    arrivals = Arrivals({*MOTOR, FORCE})
    assert arrivals.silent(100.0) == {}
    arrivals.note(dict.fromkeys(MOTOR, 0.1), 0.0)
    arrivals.note({FORCE: 1.0, 'load_cell/torque': 0.0}, 1.6)
    words = 'actuator/measured_js: nothing for 1.6 s; see whether its driver still runs'
    assert arrivals.silent(1.6) == dict.fromkeys(MOTOR, words)
    arrivals.clear()
    assert arrivals.silent(9.0) == {}


def test_what_is_not_a_number_leaves_out_its_channel_alone():
    position, effort = MOTOR
    arrivals = Arrivals(MOTOR)
    arrivals.note({position: 0.1, effort: math.nan}, 0.0)
    arrivals.note({position: 0.1, effort: math.nan}, 1.6)
    assert arrivals.silent(1.7) == {}  # it never came, and nobody waits for it
    arrivals.note({position: 0.1, effort: 0.2}, 2.0)
    arrivals.note({position: 0.1, effort: math.nan}, 4.0)
    [(name, words)] = arrivals.silent(4.0).items()
    assert name == effort
    assert 'no number for 2.0 s while others of actuator/measured_js come' in words
