from functools import cache

import pytest

from tendon_ros.blind.case import made, Settings


@cache
def cached(seed, index, **settings):
    return made(seed, index, Settings(**settings))


@pytest.fixture
def case():
    """A function that returns a case and makes it once only."""
    return cached
