"""Best subsets: sets are found that one member at a time would miss."""

import numpy as np
import pytest

from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.screening import Proposal
from tendon_ros.identify.subset import Subsets

SAMPLES = 2000


def proposal(effect, place, sizes=(0,), z=(1.0,)):
    return Proposal(Candidate(effect, place), z, sizes, (0.0,) * len(sizes))


@pytest.fixture
def signals():
    return np.random.default_rng(0).normal(size=(SAMPLES, 4))


def named(members):
    return {(m.proposal.candidate.effect, m.proposal.candidate.place) for m in members}


def test_two_that_a_third_imitates(signals):
    first, second, noise = signals[:, 0], signals[:, 1], signals[:, 2]
    between = first + second + 0.2 * noise  # alone it explains more than either
    proposals = [proposal('coulomb_friction', f'pulley_{n}') for n in '123']
    columns = [s[:, None] for s in (first, second, between)]
    left = -3.0 * first - 4.0 * second
    found = Subsets(proposals, columns, left).best(1.0, 5)
    assert named(found) == {('coulomb_friction', 'pulley_1'), ('coulomb_friction', 'pulley_2')}
    assert sorted(m.z[0] for m in found) == pytest.approx([3.0, 4.0], rel=1e-3)


def test_nothing_is_added_for_nothing(signals):
    proposals = [proposal('coulomb_friction', f'pulley_{n}') for n in '123']
    columns = [signals[:, [n]] for n in range(3)]
    left = -2.0 * signals[:, 0]
    assert len(Subsets(proposals, columns, left).best(0.05 * SAMPLES, 5)) == 1
    assert Subsets(proposals, columns, signals[:, 3]).best(0.05 * SAMPLES, 5) == []


def test_friction_never_pushes(signals):
    proposals = [proposal('coulomb_friction', 'pulley_1')]
    assert Subsets(proposals, [signals[:, [0]]], signals[:, 0]).best(1.0, 5) == []


def test_one_proposal_of_an_effect_and_place(signals):
    proposals = [proposal('torque_bias', 'motor_M'), proposal('torque_bias', 'motor_M')]
    left = signals[:, 0] + signals[:, 1]
    found = Subsets(proposals, [signals[:, [0]], signals[:, [1]]], left).best(1.0, 5)
    assert len(found) == 1


def test_what_has_no_size_is_taken_as_it_is(signals):
    whole = proposal('sensor_rectified', 'torque_M', (), (1.0,))
    other = proposal('torque_bias', 'motor_M')
    left = -signals[:, 0] - 2.0 * signals[:, 1]
    found = Subsets([whole, other], [signals[:, [0]], signals[:, [1]]], left).best(1.0, 5)
    assert named(found) == {('sensor_rectified', 'torque_M'), ('torque_bias', 'motor_M')}
    [size] = [m.z[0] for m in found if m.proposal is other]
    assert size == pytest.approx(2.0, rel=1e-3)


def test_an_event_must_explain_much_more_than_what_lasts(signals):
    lasting = proposal('torque_bias', 'motor_M')
    event = proposal('cable_slip', 'cable_12', (0,), (1.0, 5.0))
    near = signals[:, 0] + 0.3 * signals[:, 1]
    columns = [near[:, None], signals[:, [0]]]
    # the event does a little better
    left = -signals[:, 0] - 0.14 * signals[:, 1]
    found = Subsets([lasting, event], columns, left).best(1.0, 1)
    assert named(found) == {('torque_bias', 'motor_M')}
