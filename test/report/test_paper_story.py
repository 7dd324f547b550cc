"""The paper's story says what is right and what is wrong; diagnoses here are made up."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.base.recording import Channel, Recording
from tendon_ros.diagnose.result import Candidate, Cause, Diagnosis, FittedParameter, Shrink
from tendon_ros.model.effect_use import checked_use
from tendon_ros.model.instrument_file import load_instrument
from tendon_ros.model.paper.rig import under_control
from tendon_ros.model.paper.withheld_rig import STAND, WITHHELD
from tendon_ros.model.trajectory_profiles import paper_fig12
from tendon_ros.report.paper_story import CLAIMS, paper_story, rung_rows, told
from tendon_ros.report.paper_story_page import story_page, summary

#: a candidate that was given too little to be named
HELD_BACK = {
    'effect': 'pretension',
    'place': 'cable_L3',
    'probability': 0.3,
    'identifiable': True,
}

SLIP = ('cable_slip', 'cable_L3', {'jump': 1e-5, 'time': 9.7})


def cause(effect, place, parameters, same=()):
    return Cause(
        effect=effect,
        place=place,
        probability=0.9,
        parameters={
            name: FittedParameter(value=x, unit='1', ci95=(0.9 * x, 1.1 * x + 1e-9))
            for name, x in parameters.items()
        },
        indistinguishable=same,
        shrink=Shrink(channel='', unit='', before=0.0, without_this=0.0, after=0.0),
    )


def diagnosis(*causes):
    return Diagnosis.model_validate(
        {
            'schema': 1,
            'verdict': 'explained',
            'gap': (),
            'where': (),
            'causes': causes,
            'candidates': (HELD_BACK,),
            'unexplained': {'probability': 0.1},
        }
    )


@pytest.fixture(scope='module')
def stand():
    return load_instrument(STAND)


@pytest.fixture(scope='module')
def profile(stand):
    """Return the load cell over the paper's experiment on a rig with just what is withheld."""
    rows = under_control(patched(stand, WITHHELD), paper_fig12(stand.motor_names))
    force = Channel('load_cell/force', rows.time, rows.contact_force[:, 0])
    return Recording('profile', {force.name: force})


def patched(stand, uses):
    return replace(stand, effects=tuple(checked_use(stand, *use) for use in uses))


def story_of(stand, profile, uses):
    return paper_story(stand, patched(stand, uses), diagnosis(*(cause(*u) for u in uses)), profile)


@pytest.fixture(scope='module')
def right(stand, profile):
    return story_of(stand, profile, WITHHELD)


def test_claims_and_withheld_effects_are_the_same():
    claimed = {(c.effect, place) for c in CLAIMS for place in c.places}
    assert claimed == {use[:2] for use in WITHHELD}


def test_right_diagnosis_leads_to_the_force(right):
    assert [r.label.split()[0] for r in right.rungs] == ['instrument', 'numbers', '+', '+', '+']
    # Fig. 13 has 17.98 and 49.79 N; here the encoders' counts stop the controllers a little off
    assert right.rungs[0].rests['first 5 deg'] == pytest.approx(17.98, abs=0.2)
    assert right.rungs[0].rests['7 deg'] == pytest.approx(49.79, abs=0.4)
    assert right.rungs[-1].after < 1e-9 < right.rungs[0].after
    assert all(f.exactly for f in right.findings)
    assert right.wrong == ()
    assert summary(right).startswith('5 of 5 withheld effects are named; nothing is named')


def test_wrong_cause_is_said_to_be_wrong(stand, profile):
    story = story_of(stand, profile, (*WITHHELD[1:], SLIP))
    assert [c.effect for c in story.wrong] == ['cable_slip']
    assert story.findings[0].cause is None
    assert [c.effect for c in story.findings[0].instead] == ['cable_slip']
    assert story.rungs[-1].label == '+ what else was named'
    text = told(story)
    assert 'Pretension of cable L3: not named (30 %); instead cable L3 slip' in text
    assert 'Cable L3 slip: named with 90 %, and not true' in text
    assert 'wrongly named: cable L3 slip (90' in summary(story)


def test_what_looks_the_same_is_not_counted_as_named(stand, profile):
    same = (Candidate(effect='pretension', place='cable_L3'),)
    one = cause('pretension', 'cable_12', {'scale': 0.9}, same)
    found = patched(stand, [('pretension', 'cable_12', {'scale': 0.9})])
    story = paper_story(stand, found, diagnosis(one), profile)
    assert story.findings[0].cause is one
    assert not story.findings[0].exactly
    assert story.wrong == ()
    assert 'said to look the same as pretension of cable 12' in told(story)


def test_no_cause_leaves_the_gap(stand, profile):
    story = story_of(stand, profile, ())
    assert len(story.rungs) == 2
    assert story.rungs[0].after == pytest.approx(story.rungs[1].after)
    assert all(f.cause is None for f in story.findings)


def test_friction_brings_the_angle_it_builds_up_over(stand, profile):
    bristle = ('presliding_friction', 'pulley_3', {'torque': 0.0, 'angle': 1e-3})
    friction = ('tension_friction', 'pulley_3', {'coefficient': 0.1})
    found = patched(stand, (friction, bristle))
    story = paper_story(stand, found, diagnosis(cause(*friction)), profile)
    first, last = story.rungs[1], story.rungs[-1]
    assert np.array_equal(first.force, story.rungs[0].force)
    assert not np.array_equal(last.force, first.force)


def test_page_is_whole(right):
    page = story_page(right)
    assert '<html' in page
    assert 'data:image/png' in page
    assert len(rung_rows(right)) == 1 + len(right.rungs)
