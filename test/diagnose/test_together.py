"""Two that do together what one alone does take no place by themselves."""

import pytest

from tendon_ros.diagnose.result import Candidate, Cause, Diagnosis, Shrink, Unexplained
from tendon_ros.diagnose.together import alone, partner

SIDED = ('asymmetric_friction', 'pulley_M')
RUBS = ('coulomb_friction', 'pulley_M')
PULLED = ('torque_bias', 'motor_M')
FALLS = ('stribeck_friction', 'pulley_M')


def told(*sets):
    """Return a diagnosis with causes, each with what cannot be told from it."""
    causes = [
        Cause(
            effect=effect,
            place=place,
            probability=0.9,
            parameters={},
            indistinguishable=tuple(Candidate(effect=e, place=p) for e, p in others),
            shrink=Shrink(channel='', unit='', before=0.0, without_this=0.0, after=0.0),
            recording='',
        )
        for (effect, place), *others in sets
    ]
    return Diagnosis.model_construct(causes=tuple(causes), unexplained=Unexplained(probability=0))


@pytest.mark.parametrize(
    ('sets', 'expected'),
    [
        # the one, with the two beside it
        ([(SIDED, RUBS, PULLED, FALLS)], [{FALLS}]),
        # one of them alone is a rival like any other
        ([(SIDED, RUBS, FALLS)], [{RUBS, FALLS}]),
        # the two, each with the one
        ([(RUBS, SIDED, FALLS), (PULLED, SIDED)], [{FALLS}, set()]),
        # who has no partner is a rival like any other
        ([(PULLED, SIDED)], [{SIDED}]),
        ([(RUBS, SIDED), (PULLED,)], [{SIDED}, set()]),
    ],
)
def test_who_takes_a_place_alone(sets, expected):
    diagnosis = told(*sets)
    found = [{(c.effect, c.place) for c in alone(diagnosis, one)} for one in diagnosis.causes]
    assert found == expected


def test_partners_name_each_other():
    diagnosis = told((RUBS, SIDED), (PULLED, SIDED))
    one, two = diagnosis.causes
    whole = Candidate(effect=SIDED[0], place=SIDED[1])
    assert partner(diagnosis, one) == (two, whole)
    assert partner(diagnosis, two) == (one, whole)
    assert partner(told((SIDED, RUBS, PULLED)), diagnosis.causes[0]) is None
