"""Who listens asks for as much as all publishers offer, and for nothing twice."""

import pytest

from tendon_ros.nodes.terms import Terms, terms_for

LIVE, LATCHED = Terms(), Terms(latched=True)
SENSOR = Terms(reliable=False)


@pytest.mark.parametrize(
    ('offered', 'now', 'heard', 'then'),
    [
        ([], LIVE, False, LIVE),
        ([], LATCHED, True, LATCHED),
        ([LATCHED, LATCHED], LIVE, False, LATCHED),
        ([LATCHED], LIVE, True, LIVE),  # it would come twice
        ([LATCHED], LATCHED, True, LATCHED),
        ([LATCHED, LIVE], LATCHED, True, LIVE),
        ([LIVE, SENSOR], LIVE, True, SENSOR),
        ([LIVE], SENSOR, True, SENSOR),
    ],
)
def test_every_publisher_is_heard(offered, now, heard, then):
    assert terms_for(offered, now, heard=heard) == then
