"""The estimation methods by name."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
import math
from types import MappingProxyType
from typing import Any

from tendon_ros.base.errors import InstrumentError, listed
from tendon_ros.estimate.contact_angle import ContactAngleObserver
from tendon_ros.estimate.kalman import KalmanObserver
from tendon_ros.estimate.observer import Observer
from tendon_ros.estimate.static_balance import StaticBalanceObserver
from tendon_ros.model.instrument import Instrument

_BUILDERS: Mapping[str, tuple[str, Callable[..., Observer]]] = {
    'contact_angle': (
        'encoders alone, the angle of the obstacle known (the way of the paper)',
        ContactAngleObserver,
    ),
    'static_balance': (
        'encoders and torques, balance of torques without inertia',
        StaticBalanceObserver,
    ),
    'dynamic': ('encoders and torques, with dynamics: extended Kalman filter', KalmanObserver),
}

#: what each method is, by name
METHODS: Mapping[str, str] = MappingProxyType(
    {name: text for name, (text, _) in _BUILDERS.items()}
)


def build_observer(
    instrument: Instrument,
    method: str,
    *,
    channels: Sequence[str] | None = None,
    wander: float | None = None,
    engine: str = 'auto',
) -> Observer:
    """
    Return an observer.

    :param instrument: the network.
    :param method: a key of :data:`METHODS`.
    :param channels: for ``static_balance``: the channels to use; the motors' own where None.
    :param wander: not for ``contact_angle``: by how much the force wanders in a second [N or N m],
        after another time by its square root as much; None where nothing is known of it.
    :param engine: ``auto``, ``compiled`` or ``plain``.
    :return: the observer.
    :raises InstrumentError: where there is no such method, or it does not fit the instrument.
    """
    if method not in _BUILDERS:
        raise InstrumentError(f'method: no method {method!r}; there are {listed(_BUILDERS)}')
    options: dict[str, Any] = {'engine': engine}
    if channels is not None:
        if method != 'static_balance':
            raise InstrumentError(
                f"method: {method} reads the motors' own channels; choose channels with "
                'static_balance'
            )
        options['channels'] = channels
    if wander is not None:
        if method == 'contact_angle':
            raise InstrumentError(
                f'method: {method} looks at each measurement alone; say how far the force '
                'wanders with static_balance or dynamic'
            )
        if not 0.0 < wander < math.inf:
            raise InstrumentError(f'wander {wander:g}: must be positive, in N or N m')
        options['wander'] = wander
    return _BUILDERS[method][1](instrument, **options)
