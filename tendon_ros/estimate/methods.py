"""The estimation methods by name."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType

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


def build(
    instrument: Instrument,
    method: str,
    *,
    channels: Sequence[str] | None = None,
    engine: str = 'auto',
) -> Observer:
    """
    Return an observer.

    :param instrument: the network.
    :param method: a key of :data:`METHODS`.
    :param channels: for ``static_balance``: the channels to use; the motors' own where None.
    :param engine: ``auto``, ``compiled`` or ``plain``.
    :return: the observer.
    :raises InstrumentError: where there is no such method, or it does not fit the instrument.
    """
    if method not in _BUILDERS:
        raise InstrumentError(f'method: no method {method!r}; there are {listed(_BUILDERS)}')
    maker = _BUILDERS[method][1]
    if channels is None:
        return maker(instrument, engine=engine)
    if method != 'static_balance':
        raise InstrumentError(
            f"method: {method} reads the motors' own channels; choose channels with static_balance"
        )
    return maker(instrument, channels=channels, engine=engine)
