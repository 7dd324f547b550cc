"""Measurements are joined by stamp, in order, whatever order their halves come in."""

from tendon_ros.estimate import Synchroniser


def test_halves_join_in_any_order():
    """A measurement is complete when its last half has come."""
    join = Synchroniser(['a', 'b'])
    assert join.add(10, {'a': 1.0}) is None
    assert join.add(20, {'b': 4.0}) is None
    done = join.add(10, {'b': 2.0})
    assert done is not None
    assert (done.stamp_ns, done.values) == (10, {'a': 1.0, 'b': 2.0})
    later = join.add(20, {'a': 3.0})
    assert later is not None
    assert later.values == {'a': 3.0, 'b': 4.0}


def test_a_half_that_never_completes_is_dropped_and_counted():
    """A later complete one passes it, so that measurements stay in order."""
    join = Synchroniser(['a', 'b'])
    join.add(10, {'a': 1.0})
    assert join.add(20, {'a': 1.0, 'b': 2.0}) is not None
    assert join.dropped == 1


def test_patience_ends():
    """Memory stays bounded when a topic is silent."""
    join = Synchroniser(['a', 'b'], patience=5)
    for stamp in range(20):
        join.add(stamp, {'a': 0.0})
    assert join.dropped == 15


def test_what_nobody_needs_is_not_kept():
    """Values of other topics neither wait nor complete anything."""
    join = Synchroniser(['a'], patience=1)
    for stamp in range(5):
        assert join.add(stamp, {'c': 0.0}) is None
    assert join.dropped == 0
