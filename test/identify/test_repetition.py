"""What a machine does not do again alike: between cycles of a motion, between recordings of it."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.identify.repetition import cycle, unrepeated
from tendon_ros.identify.segment import Measured, Segment
from tendon_ros.model.instrument import Sensor
from tendon_ros.model.signals import Signals

PERIOD = 0.01
BINS = 2000
TIME = PERIOD * (np.arange(BINS) + 0.5)


def segment_of(*motions, name='run', pushed=()):
    rows = np.array(motions)
    return Segment(
        name=name,
        period=PERIOD,
        time=TIME,
        prescribed=('M',),
        motion=Signals(rows, np.zeros_like(rows), 0.0, PERIOD),
        measured=(
            Measured(
                Sensor('torque_M', 'torque', 'M', 'actuator/pulley_M/effort'),
                np.zeros(BINS),
                np.ones(BINS),
                0.0,
            ),
        ),
        contacts=(),
        pose={},
        pushed=pushed,
    )


@pytest.fixture
def rng():
    return np.random.default_rng(3)


@pytest.mark.parametrize('seconds', [0.9, 2.0, 4.9])
def test_the_cycle_of_a_periodic_motion_is_found(seconds, rng):
    turns = 2.0 * np.pi * TIME / seconds
    motion = np.sin(turns) + 0.4 * np.sin(2.0 * turns) + 1e-3 * rng.normal(size=BINS)
    assert cycle(segment_of(motion)) == pytest.approx(seconds / PERIOD, abs=1.0)


def test_motions_that_never_come_back_have_no_cycle(rng):
    multisine = np.sin(2.0 * TIME) + np.sin(4.71 * TIME) + np.sin(7.3 * TIME)
    assert cycle(segment_of(multisine)) == 0
    assert cycle(segment_of(np.interp(TIME, [0, 4, 8, 12, 20], [0, 5, 7, 5, 4]))) == 0
    assert cycle(segment_of(np.zeros(BINS))) == 0
    # three cycles: what changes once would lie between most of them
    assert cycle(segment_of(np.sin(2.0 * np.pi * TIME / 6.6))) == 0


def test_what_is_still_does_not_hide_a_cycle_and_a_load_that_differs_does(rng):
    motion = np.sin(2.0 * np.pi * TIME / 2.0)
    held = 1e-4 * rng.normal(size=BINS)
    still = replace(segment_of(motion, held), prescribed=('M', 'L'))
    assert cycle(still) == 200
    assert cycle(segment_of(motion, 0.01 * np.exp(-TIME / 4.0), pushed=('jaw',))) == 0


def test_what_differs_between_cycles_is_found_and_what_repeats_is_not(rng):
    turns = 2.0 * np.pi * TIME / 2.0
    wander = np.convolve(rng.normal(size=BINS), np.ones(40) / np.sqrt(40.0), mode='same')
    left = np.sin(turns) ** 3 + 0.1 * wander
    [[found]] = unrepeated([segment_of(np.sin(turns))], [[left]])
    assert found == pytest.approx(0.1, rel=0.3)


@pytest.mark.parametrize('seconds', [0.9, 2.0, 4.9])
@pytest.mark.parametrize(
    'change',
    [3.0 * (TIME > 10.0), 3.0 * ((TIME > 9.0) & (TIME < 9.6)), 2.0 * np.exp(-TIME / 10.0)],
    ids=['slip', 'push', 'creep'],
)
def test_what_changes_once_or_slowly_is_not_taken_for_noise(seconds, change, rng):
    turns = 2.0 * np.pi * TIME / seconds
    left = np.sin(turns) ** 3 + 0.1 * rng.normal(size=BINS) + change
    [[found]] = unrepeated([segment_of(np.sin(turns))], [[left]])
    assert found < 0.13


def test_what_differs_between_recordings_of_one_motion_is_found_from_three_on(rng):
    motion = np.sin(2.0 * TIME) + np.sin(4.71 * TIME) + np.sin(7.3 * TIME)
    wander = [
        np.convolve(rng.normal(size=BINS), np.ones(40) / np.sqrt(40.0), mode='same')
        for _ in range(4)
    ]
    left = [[np.cos(3.0 * TIME) + 0.2 * w] for w in wander]
    runs = [segment_of(motion, name=f'run_{n}') for n in range(4)]
    assert unrepeated(runs[:2], left[:2]) == [[0.0], [0.0]]
    found = unrepeated(runs, left)
    assert np.mean(found) == pytest.approx(0.2, rel=0.25)
    # a channel that was dead once, a motor that only held, a recording that ended sooner
    dead = [[row[0] * np.nan] if n == 1 else row for n, row in enumerate(left)]
    assert np.mean([f for n, f in enumerate(unrepeated(runs, dead)) if n != 1]) > 0.1
    held = [
        replace(segment_of(motion, 1e-4 * rng.normal(size=BINS)), prescribed=('M', 'L'))
        for _ in left
    ]
    assert np.mean(unrepeated(held, left)) == pytest.approx(0.2, rel=0.25)
    short = replace(runs[0], time=TIME[:-30])
    again = unrepeated([short, *runs[1:]], [[left[0][0][:-30]], *left[1:]])
    assert np.mean(again) == pytest.approx(0.2, rel=0.25)
    others = [*runs[:2], segment_of(1.2 * motion), segment_of(motion, 0.0 * motion, pushed=('L',))]
    assert unrepeated(others, left) == [[0.0]] * 4
