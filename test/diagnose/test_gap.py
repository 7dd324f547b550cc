"""The gap is a number whatever a model does."""

import numpy as np

from tendon_ros.diagnose.gap import DIVERGED, gaps
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.diagnose.result import ChannelGap
from tendon_ros.identify.rollout import Rollouts
from tendon_ros.model.instrument_file import load_instrument


def test_a_model_that_diverges_is_off_by_a_number_that_can_be_read_back(measured_on, monkeypatch):
    body = load_instrument('single_body')
    held = prepared([measured_on(body)], body).held
    # what rollouts give for a model that cannot be computed
    wild = [np.full(m.shape, np.inf) for m in held.rollouts.measured]
    monkeypatch.setattr(Rollouts, 'predicted', lambda *_: tuple(wild))
    [gap] = gaps(held, held.empty, held.empty)
    assert gap.after > 0.9 * DIVERGED * gap.noise_floor
    assert ChannelGap.model_validate_json(gap.model_dump_json()) == gap
