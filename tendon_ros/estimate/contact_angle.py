"""
The paper's way: encoders alone, with the angle at which the tip meets its obstacle known.

The motors move as measured; eqs. (1)-(6) say where everything else goes and with what force the
tip pushes against the obstacle, which is the instrument's contact.
"""

from __future__ import annotations

import numpy as np

from tendon_ros.estimate.channels import (
    angle_channel,
    estimated_angles,
    operating_force,
    sensors_of,
)
from tendon_ros.estimate.observer import Estimate, Measurement, Observer
from tendon_ros.model.instrument import Instrument
from tendon_ros.model.layout import arrays_of
from tendon_ros.model.runner import Runner
from tendon_ros.model.signals import Signals
from tendon_ros.model.statics import Statics


class ContactAngleObserver(Observer):
    """
    Runs the model along the measured motion of the motors.

    The stated uncertainty is that of the encoders alone, carried through the stiffness of the
    network; errors of the model are what the diagnosis is for.

    :param instrument: with a contact at the known angle.
    :param engine: ``auto``, ``compiled`` or ``plain``.
    """

    def __init__(self, instrument: Instrument, *, engine: str = 'auto') -> None:
        super().__init__(instrument)
        self._instrument = instrument
        self._operating = operating_force(instrument)
        self._contact = instrument.contacts.index(self._operating.contact)
        driven = instrument.driven
        self.needs = tuple(angle_channel(instrument, name) for name in driven)
        arrays = arrays_of(instrument, prescribed={name: row for row, name in enumerate(driven)})
        self._runner = Runner(instrument, arrays, engine)
        self._statics = Statics(instrument, engine=engine)
        encoders = sensors_of(instrument, ('angle',))
        self._sigma = np.array([self._doubt(encoders[name]) for name in self.needs])
        self._reset()

    def _reset(self) -> None:
        self._before = np.zeros(0)

    def _update(self, measurement: Measurement, gap: float) -> Estimate:
        now = np.array([measurement.values[name] for name in self.needs])
        before = self._before
        if not before.size:
            # the first measurement finds the mechanics at rest in the rigid pose of its angles
            pose = dict(zip(self._instrument.driven, now, strict=True))
            self._runner.rest(pose)
            before, gap = now, SETTLING
        start = self._runner.time
        path = Signals.straight(start, gap, before, now)
        row = self._runner.glide(start + gap, path)
        self._before = now
        angle = row.angle[0]
        force = float(row.contact_force[0, self._contact])
        scale = self._operating.contact.arm if self._operating.quantity == 'torque' else 1.0
        values = {
            self._operating.channel: force * scale,
            f'{self._operating.channel}_std': self._deviation(angle, force) * scale,
            **estimated_angles(self._instrument, angle),
        }
        return Estimate(measurement.stamp_ns, values)

    def _deviation(self, angle: np.ndarray, force: float) -> float:
        """Return the standard deviation of the force that the encoders' own errors make."""
        if force <= 0.0:
            return 0.0
        stiffness = self._statics.at(angle, np.zeros_like(angle)).stiffness
        driven = [self._instrument.index(name) for name in self._instrument.driven]
        inner = [i for i in range(len(angle)) if i not in driven]
        contact = self._operating.contact
        ratio = np.zeros(len(angle))
        for name, value in contact.route.items():
            ratio[self._instrument.index(name)] = value
        wall = contact.stiffness * contact.arm**2 * np.outer(ratio, ratio)
        total = stiffness + wall
        follow = np.linalg.solve(total[np.ix_(inner, inner)], -total[np.ix_(inner, driven)])
        by_motor = contact.stiffness * contact.arm * (ratio[inner] @ follow + ratio[driven])
        return float(np.linalg.norm(by_motor * self._sigma))


#: time that the mechanics is given to settle at the first measurement [s]
SETTLING = 2.0
