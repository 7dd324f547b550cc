"""Distances against closed forms."""

import numpy as np
import pytest

from tendon_ros.identify.excitation_evidence import CYCLES, ENOUGH, Evidence, FORM


def evidence(rows, prior=(), signature=0.0):
    table = np.array(rows, dtype=float)
    return Evidence(table @ table.T, np.array(prior, dtype=float), signature, 6.0)


def test_nothing_imitates():
    alone = evidence([[3.0, 4.0]])
    assert alone.distance(1.0) == pytest.approx(5.0)
    assert alone.distance(4.0) == pytest.approx(10.0)
    assert alone.seconds == 6.0


def test_a_free_unknown_takes_its_direction():
    left = evidence([[3.0, 4.0], [2.0, 0.0]], prior=[0.0])
    assert left.distance(1.0) == pytest.approx(4.0, rel=1e-6)
    assert left.imitation() == pytest.approx([1.5], rel=1e-6)


def test_a_bounded_unknown_costs_what_it_moves():
    # one sample: 3 = x + noise with x of deviation 1: (3 / sqrt(2))^2
    assert evidence([[3.0], [1.0]], prior=[1.0]).distance(1.0) == pytest.approx(3.0 / 2.0**0.5)


def test_what_the_form_misses_is_taken_off():
    assert evidence([[10.0]], signature=400.0).distance(1.0) == pytest.approx(10.0 - FORM * 20.0)
    never = evidence([[1.0]], signature=400.0)
    assert never.seconds == np.inf
    assert never.rate == 0.0


def test_weak_evidence_takes_longer():
    weak = evidence([[1.0]])
    cycles = next(c for c in CYCLES if c >= ENOUGH**2)
    assert weak.seconds == cycles * 6.0


def test_channels_add():
    parts = [evidence([[3.0], [0.0]], [0.0], 1.0), evidence([[4.0], [0.0]], [0.0], 2.0)]
    both = Evidence.joined(parts)
    assert both.distance(1.0) == pytest.approx(5.0 - FORM * 3.0**0.5)
