"""Fixtures that several folders of tests share."""

from pathlib import Path

import pytest

#: recordings that do not come with the package; tests that want them skip without
SHARED = Path(__file__).resolve().parents[2] / 'shared'


def _shared(relative: str) -> Path:
    path = SHARED / relative
    if not path.exists():
        pytest.skip(f'{path} is not there')
    return path


@pytest.fixture(scope='session')
def shared():
    """Return the folder with shared recordings; skip where it is absent."""
    return _shared('.')


@pytest.fixture(scope='session')
def practice():
    """Return the folder of the practice bags; skip where it is absent."""
    return _shared('practice')


@pytest.fixture(scope='session')
def davinci_npz():
    """Return the file of the da Vinci grasper's runs; skip where it is absent."""
    return _shared('recordings/davinci_grasper/Tool_5_Maryland_L_3.npz')
