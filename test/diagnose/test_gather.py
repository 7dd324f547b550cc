"""What is said beside the verdict: channels that others spoil."""

import pytest

from tendon_ros.diagnose.gather import worse_words
from tendon_ros.diagnose.result import ChannelGap

EFFORT = 'actuator/pulley_body/effort'


@pytest.mark.parametrize(
    ('before', 'after', 'said'), [(1.1, 1.7, True), (1.1, 1.2, False), (0.5, 0.9, False)]
)
def test_a_channel_that_others_spoil_is_said(before, after, said):
    gap = ChannelGap(
        channel=EFFORT, unit='N m', before=before, after=after, noise_floor=0.9, ci95=(0.0, 2.0)
    )
    assert bool(worse_words([gap])) is said
