"""
The errors of the package.

Every error that a user can cause is a :class:`TendonError`: one line that names the place, what is
wrong there, and the mend. The command line prints that line and leaves with status 2; a node logs
it. Anything else that is raised is a defect of the package.
"""

from __future__ import annotations

from collections.abc import Iterable


class TendonError(Exception):
    """A mistake in what the user gave: the message names the place, the fault and the mend."""


class InstrumentError(TendonError):
    """An instrument file, or a change to an instrument, that cannot be used."""


class RecordingError(TendonError):
    """A bag, a channel or a measurement that cannot be used."""


class TrajectoryError(TendonError):
    """A trajectory that is malformed or beyond the limits of the instrument."""


class SimulationError(TendonError):
    """A simulation that diverged, or that was asked for what it cannot do."""


class EffectError(TendonError):
    """An effect, a place or an effect parameter that does not exist or is out of bounds."""


class OutputError(TendonError):
    """A place that cannot be written to, or that holds what must not be replaced."""


def listed(names: Iterable[str]) -> str:
    """
    Return names as a readable list for an error message.

    :param names: the names that exist.
    :return: ``'a, b, c'``, or ``'none'`` where there are none.
    """
    return ', '.join(sorted(str(name) for name in names)) or 'none'
