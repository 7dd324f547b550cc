"""
Tolerances: how far the numbers of an instrument file may be off without being a cause.

Every number that was measured is a little wrong. A diagnosis that did not let them move would
explain a percent of stiffness with friction.
"""

from __future__ import annotations

from dataclasses import dataclass
import math

from tendon_ros.identify.axis import Axis
from tendon_ros.model.instrument import Instrument

# what a careful nameplate, scale or spring balance leaves open, relative, one deviation
MEASURED = 0.02
REACH = 3.0  # deviations; what lies beyond is a cause
DAMPING = 0.06  # dampings are never known as well


@dataclass(frozen=True)
class Tolerance:
    """One number of the file that may move: the effect that moves it, and how far it may."""

    effect: str
    place: str
    quantity: str
    axis: Axis


def tolerances(instrument: Instrument) -> tuple[Tolerance, ...]:
    """
    Return what may move in an instrument.

    :param instrument: the network.
    :return: its inertias, dampings, preloads and stiffnesses, with the tolerance of the file or,
        where it names none, that of a careful measurement.
    """
    found: list[Tolerance] = []

    def add(
        effect: str, place: str, quantity: str, unit: str, nominal: float, usual: float
    ) -> None:
        sigma = instrument.tolerances.get(f'{place}.{quantity}', usual)
        wide = math.isinf(sigma)
        scale = (0.5 if wide else sigma) * nominal
        if scale <= 0.0:
            return
        centre = 1.0 if unit == '1' else 0.0
        found.append(
            Tolerance(
                effect,
                place,
                quantity,
                _axis(quantity, unit, centre, scale, wide=wide),
            )
        )

    for pulley in instrument.pulleys:
        place = f'pulley_{pulley.name}'
        add('inertia', place, 'inertia', '1', 1.0, MEASURED)
        add('viscous_friction', place, 'damping', 'N m s/rad', pulley.damping, DAMPING)
    for loop in instrument.loops:
        place = f'cable_{loop.name}'
        add('pretension', place, 'pretension', '1', 1.0 if loop.pretension > 0.0 else 0.0,
            MEASURED)  # fmt: skip
        add('cable_stiffness', place, 'stiffness', '1', 1.0, MEASURED)
    for contact in instrument.contacts:
        place = 'contact' if len(instrument.contacts) == 1 else f'contact_{contact.name}'
        add('contact_stiffness', place, 'stiffness', '1', 1.0, MEASURED)
    return tuple(found)


def _axis(quantity: str, unit: str, centre: float, scale: float, *, wide: bool) -> Axis:
    """Return the axis of a tolerance: three deviations either way, or nearly anything."""
    reach = 4.0 if wide else REACH
    low = centre - reach * scale if not wide else (0.02 if unit == '1' else -1e3)
    high = centre + reach * scale if not wide else (50.0 if unit == '1' else 1e3)
    return Axis(quantity, unit, low, high, centre, scale, spread=reach if wide else 1.0)
