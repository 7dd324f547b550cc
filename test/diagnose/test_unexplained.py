"""How likely something has a cause that was not named, and where nobody has looked."""

from types import SimpleNamespace

import pytest

from tendon_ros.diagnose import unexplained
from tendon_ros.diagnose.naming import NAMED
from tendon_ros.diagnose.unexplained import left_over, surprising


@pytest.mark.parametrize(('left', 'form'), [(0.03, 0.0), (0.138, 0.029), (0.124, 0.022)])
def test_noise_that_wanders_is_no_gap(left, form):
    # the last two: sound simulated belts whose sensors drift
    assert left_over(left, form) < NAMED


@pytest.mark.parametrize(('left', 'form'), [(0.2, 0.0), (0.5, 0.18), (20.0, 3.0)])
def test_what_stays_beyond_noise_and_laws_has_a_cause(left, form):
    assert left_over(left, form) > NAMED


@pytest.mark.parametrize(
    ('unseen', 'left', 'form', 'surprise'),
    [
        (0.1, 0.0, 0.0, False),
        (0.5, 0.0, 0.0, True),
        # as wrong in what was fitted
        (0.5, 0.2, 0.0, False),
        # laws may be wrong by that, and were not in what was fitted
        (0.5, 0.0, 0.4, False),
        (2.5, 0.2, 0.4, True),
    ],
)
def test_what_no_fit_could_know_is_a_surprise(monkeypatch, unseen, left, form, surprise):
    monkeypatch.setattr(unexplained, 'form_power', lambda *_: form)
    final = SimpleNamespace(left=left, model=None)
    problem = SimpleNamespace(structures=lambda power: (None, power))
    held = SimpleNamespace(structures=lambda power: (None, power), left=lambda _model: unseen)
    ready = SimpleNamespace(problem=problem, held=held)
    assert surprising(ready, SimpleNamespace(start=None, final=final)) is surprise
