"""
The form of an instrument file: sections, keys, units. What refers to what is checked elsewhere.

How the text of a field is read is said in :mod:`tendon_ros.model.instrument_fields`.
``docs/instrument_file.md`` explains the keys to a user.
"""

from __future__ import annotations

from difflib import get_close_matches
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, model_validator
from pydantic_core import PydanticCustomError

from tendon_ros.base.errors import listed
from tendon_ros.model.instrument import DAMPING_UNITS
from tendon_ros.model.instrument_fields import (
    By,
    column,
    Count,
    Damping,
    Factor,
    Inertia,
    Name,
    quantity,
    Radius,
    Ratio,
    Sign,
    stated,
    Switch,
    Zero,
)
from tendon_ros.model.tolerance import Stated


class Section(BaseModel):
    """A mapping of the file: unknown keys and missing ones are errors that say what exists."""

    model_config = ConfigDict(extra='forbid', frozen=True)

    @model_validator(mode='before')
    @classmethod
    def check_keys(cls, value: object) -> object:
        """
        Refuse what is no mapping, a key that does not exist, and the lack of one that must.

        :param value: what the file holds.
        :return: the same.
        """
        if not isinstance(value, dict):
            example = next(iter(cls.model_fields))
            raise PydanticCustomError(
                'section',
                'is not a section; write `key: value` pairs, such as `{example}: ...`',
                {'example': example},
            )
        for key in value:
            if key not in cls.model_fields:
                close = get_close_matches(key, cls.model_fields, n=1)
                raise PydanticCustomError(
                    'key',
                    'unknown key{hint}; there are {names}',
                    {
                        'key': key,
                        'hint': f', did you mean {close[0]!r}?' if close else '',
                        'names': listed(cls.model_fields),
                    },
                )
        for key, info in cls.model_fields.items():
            if info.is_required() and key not in value:
                raise PydanticCustomError('key', 'is missing; write it', {'key': key})
        return value


class PulleySection(Section):
    """A body that turns."""

    inertia: Inertia
    damping: Damping = Stated(0.0)


class CurveSection(Section):
    """Tension of one cable against its elongation, as a file of its own holds it."""

    elongation: Annotated[tuple[float, ...], column('m')]
    tension: Annotated[tuple[float, ...], column('N')]


class LoopSection(Section):
    """A closed loop of two preloaded cables."""

    route: dict[Name, Radius]
    curve: Name
    pretension: Annotated[Stated, stated('N', 'not negative')]
    damping: Annotated[Stated, stated('N*s/m', 'not negative')] = Stated(0.0)
    stiffness: Factor = Stated(1.0)  # on the tensions of its curve
    hardening: Factor = Stated(1.0)  # exponent on the elongations of its curve
    torque_sign: dict[Name, Sign] = {}


class CouplingSection(Section):
    """A torsion spring between pulleys."""

    route: dict[Name, Ratio]
    stiffness: Annotated[Stated, stated('N*m/rad', 'positive')]
    damping: Damping = Stated(0.0)


class ControllerSection(Section):
    """A motor's position controller."""

    kp: Annotated[float, quantity('N*m/rad', 'not negative')]
    ki: Annotated[float, quantity('N*m/(rad*s)', 'not negative')] = 0.0
    kd: Annotated[float, quantity('N*m*s/rad', 'not negative')] = 0.0
    limit: Annotated[float, quantity('N*m', 'positive')]
    derivative: Literal['error', 'reading'] = 'error'


class EncoderSection(Section):
    """An angle sensor; ``counts`` a turn of what it sits on, or ``resolution`` directly."""

    counts: Count | None = None
    resolution: Annotated[float, quantity('rad', 'not negative')] = 0.0
    noise: Annotated[float, quantity('rad', 'not negative')] = 0.0
    misfit: Annotated[float, quantity('rad', 'not negative')] = 0.0

    @model_validator(mode='after')
    def check_one_resolution(self) -> EncoderSection:
        """
        Refuse two resolutions.

        :return: itself.
        """
        if self.counts is not None and self.resolution:
            raise ValueError('has both counts and resolution; keep one of them')
        return self


class JointSensorSection(EncoderSection):
    """An angle sensor on a pulley without a motor; its zero may be another in every recording."""

    zero: Zero = ''


class TorqueSensorSection(Section):
    """A torque reading."""

    resolution: Annotated[float, quantity('N*m', 'not negative')] = 0.0
    noise: Annotated[float, quantity('N*m', 'not negative')] = 0.0
    misfit: Annotated[float, quantity('N*m', 'not negative')] = 0.0


class SpeedSensorSection(Section):
    """A sensor of how fast a pulley turns."""

    resolution: Annotated[float, quantity('rad/s', 'not negative')] = 0.0
    noise: Annotated[float, quantity('rad/s', 'not negative')] = 0.0
    misfit: Annotated[float, quantity('rad/s', 'not negative')] = 0.0


class ShaftSensorSection(TorqueSensorSection):
    """A torque sensor between a pulley and the loop or coupling that pulls at it."""

    through: Name


#: what a load cell reads, in the unit of what it measures
Load = Annotated[float, quantity(By('measures', {'force': 'N', 'torque': 'N*m'}), 'not negative')]


class LoadCellSection(Section):
    """What measures a contact; its numbers are in N, or N*m where it measures torque."""

    contact: Name = ''
    measures: Literal['force', 'torque'] = 'force'
    resolution: Load = 0.0
    noise: Load = 0.0
    misfit: Load = 0.0


class MotorSection(Section):
    """A motor on a pulley."""

    pulley: Name = ''
    controller: ControllerSection | None = None
    gear_ratio: Annotated[float, quantity('1', 'positive')] = 1.0
    rotor_inertia: Annotated[float, quantity('kg*m^2', 'not negative')] = 0.0
    torque_limit: Annotated[float, quantity('N*m', 'positive')] = float('inf')
    speed_limit: Annotated[float, quantity('rad/s', 'positive')] = float('inf')
    torque_gain: Factor = Stated(1.0)  # on the torque that it reports
    position_limit: list[Annotated[float, quantity('rad')]] = [float('-inf'), float('inf')]
    encoder: EncoderSection = EncoderSection()
    torque_sensor: TorqueSensorSection = TorqueSensorSection()


class ContactSection(Section):
    """A one-sided stop."""

    route: dict[Name, Ratio]
    arm: Annotated[float, quantity('m', 'positive')]
    stiffness: Annotated[Stated, stated('N/m', 'positive')]
    law: Literal['hunt_crossley', 'spring_damper'] = 'hunt_crossley'
    damping: Annotated[Stated, stated(By('law', DAMPING_UNITS), 'not negative')] = Stated(0.0)
    position: Annotated[Stated, stated('rad')] = Stated(0.0)
    enabled: Switch = True


class ControlSection(Section):
    """How often the controllers run."""

    rate: str = ''
    period: Annotated[float, quantity('s', 'positive')] | None = None


class EffectSection(Section):
    """An effect in force."""

    effect: str
    place: str
    parameters: dict[str, str] = {}


class InstrumentSection(Section):
    """A whole file, after ``base`` and the files of curves were read."""

    name: str = ''
    description: str = ''
    pulleys: dict[Name, PulleySection]
    curves: dict[Name, CurveSection] = {}
    loops: dict[Name, LoopSection] = {}
    couplings: dict[Name, CouplingSection] = {}
    motors: dict[Name, MotorSection]
    contacts: dict[Name, ContactSection] = {}
    joint_sensors: dict[Name, JointSensorSection] = {}
    speed_sensors: dict[Name, SpeedSensorSection] = {}
    shaft_sensors: dict[Name, ShaftSensorSection] = {}
    load_cell: LoadCellSection | None = None
    control: ControlSection = ControlSection()
    effects: list[EffectSection] = []
