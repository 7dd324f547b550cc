"""
The form of an instrument file: sections, keys, units. What refers to what is checked elsewhere.

Every scalar arrives as text (see :mod:`tendon_ros.model.yaml_text`); each field says how to read
it. ``docs/instrument_file.md`` explains the keys to a user.
"""

from __future__ import annotations

from difflib import get_close_matches
import re
from typing import Annotated, Literal

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    model_validator,
    PlainValidator,
)
from pydantic_core import PydanticCustomError

from tendon_ros.base.errors import listed
from tendon_ros.model.quantity import parsed
from tendon_ros.model.tolerance import read_stated, read_tolerance, Stated


def _quantity(unit: str, sign: str = '') -> BeforeValidator:
    """
    Return a validator that reads a quantity.

    :param unit: its SI unit.
    :param sign: ``positive``, ``not negative``, ``not zero`` or nothing.
    :return: the validator.
    """

    def read(text: object) -> float:
        value = text if isinstance(text, float) else parsed(text, unit)
        _check_sign(text, value, sign)
        return value

    return BeforeValidator(read)


def _stated(unit: str, sign: str = '') -> PlainValidator:
    """
    Return a validator that reads a quantity which may carry a tolerance.

    :param unit: its SI unit.
    :param sign: as for :func:`_quantity`.
    :return: the validator.
    """

    def read(text: object) -> Stated:
        stated = read_stated(text, unit)
        _check_sign(text, stated.value, sign)
        return stated

    return PlainValidator(read)


def _check_sign(text: object, value: float, sign: str) -> None:
    holds = {'positive': value > 0, 'not negative': value >= 0, 'not zero': value != 0}
    if not holds.get(sign, True):
        raise ValueError(f'{text!r} must be {sign}')


def _read_name(text: str) -> str:
    if not re.fullmatch('[A-Za-z0-9_]+', text):
        raise ValueError(f'{text!r} is no name; use letters (a-z), digits and underscores')
    return text


def _read_count(text: object) -> int:
    number = str(text)
    if not number.isdecimal() or int(number) < 1:
        raise ValueError(f'{text!r} is not a whole number of at least 1; write one such as 28000')
    return int(number)


def _read_column(unit: str) -> BeforeValidator:
    """Return a validator that reads ``{mm: [0, 0.1, ...]}`` as numbers in an SI unit."""

    def read(value: object) -> tuple[float, ...]:
        mend = f'write a unit and its numbers, such as {{{_COLUMN_UNITS[unit]}: [0, 0.5, 1]}}'
        if not isinstance(value, dict) or len(value) != 1:
            raise ValueError(f'is not one unit with a list; {mend}')
        [(own, numbers)] = value.items()
        if not isinstance(numbers, list):
            raise ValueError(f'{own} holds no list; {mend}')
        return tuple(parsed(f'{number} {own}', unit) for number in numbers)

    return BeforeValidator(read)


_COLUMN_UNITS = {'m': 'mm', 'N': 'N'}

Name = Annotated[str, AfterValidator(_read_name)]
Count = Annotated[int, BeforeValidator(_read_count)]
Switch = Annotated[bool, Field(strict=False)]
Radius = Annotated[float, _quantity('m', 'not zero')]
Ratio = Annotated[float, _quantity('1', 'not zero')]
Sign = Literal['1', '-1', '+1']
Inertia = Annotated[Stated, _stated('kg*m^2', 'positive')]
Damping = Annotated[Stated, _stated('N*m*s/rad', 'not negative')]
#: a factor on numbers that stand elsewhere, of which only the tolerance can be given
Factor = Annotated[Stated, PlainValidator(lambda text: Stated(1.0, read_tolerance(text)))]


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

    elongation: Annotated[tuple[float, ...], _read_column('m')]
    tension: Annotated[tuple[float, ...], _read_column('N')]


class LoopSection(Section):
    """A closed loop of two preloaded cables."""

    route: dict[Name, Radius]
    curve: Name
    pretension: Annotated[Stated, _stated('N', 'not negative')]
    damping: Annotated[Stated, _stated('N*s/m', 'not negative')] = Stated(0.0)
    stiffness: Factor = Stated(1.0)  # on the tensions of its curve
    torque_sign: dict[Name, Sign] = {}


class CouplingSection(Section):
    """A torsion spring between pulleys."""

    route: dict[Name, Ratio]
    stiffness: Annotated[Stated, _stated('N*m/rad', 'positive')]
    damping: Damping = Stated(0.0)


class ControllerSection(Section):
    """A motor's position controller."""

    kp: Annotated[float, _quantity('N*m/rad', 'not negative')]
    ki: Annotated[float, _quantity('N*m/(rad*s)', 'not negative')] = 0.0
    kd: Annotated[float, _quantity('N*m*s/rad', 'not negative')] = 0.0
    limit: Annotated[float, _quantity('N*m', 'positive')]


class EncoderSection(Section):
    """An angle sensor; ``counts`` a turn of what it sits on, or ``resolution`` directly."""

    counts: Count | None = None
    resolution: Annotated[float, _quantity('rad', 'not negative')] = 0.0
    noise: Annotated[float, _quantity('rad', 'not negative')] = 0.0

    @model_validator(mode='after')
    def check_one_resolution(self) -> EncoderSection:
        """
        Refuse two resolutions.

        :return: itself.
        """
        if self.counts is not None and self.resolution:
            raise ValueError('has both counts and resolution; keep one of them')
        return self


class TorqueSensorSection(Section):
    """A torque reading."""

    resolution: Annotated[float, _quantity('N*m', 'not negative')] = 0.0
    noise: Annotated[float, _quantity('N*m', 'not negative')] = 0.0


class ShaftSensorSection(TorqueSensorSection):
    """A torque sensor between a pulley and the loop or coupling that pulls at it."""

    through: Name


class LoadCellSection(Section):
    """What measures a contact; noise and resolution are in N, or N*m where it measures torque."""

    contact: Name = ''
    measures: Literal['force', 'torque'] = 'force'
    resolution: str = ''
    noise: str = ''


class MotorSection(Section):
    """A motor on a pulley."""

    pulley: Name = ''
    controller: ControllerSection
    gear_ratio: Annotated[float, _quantity('1', 'positive')] = 1.0
    rotor_inertia: Annotated[float, _quantity('kg*m^2', 'not negative')] = 0.0
    torque_limit: Annotated[float, _quantity('N*m', 'positive')] = float('inf')
    speed_limit: Annotated[float, _quantity('rad/s', 'positive')] = float('inf')
    torque_gain: Factor = Stated(1.0)  # on the torque that it reports
    position_limit: list[Annotated[float, _quantity('rad')]] = [float('-inf'), float('inf')]
    encoder: EncoderSection = EncoderSection()
    torque_sensor: TorqueSensorSection = TorqueSensorSection()


class ContactSection(Section):
    """A one-sided stop."""

    route: dict[Name, Ratio]
    arm: Annotated[float, _quantity('m', 'positive')]
    stiffness: Annotated[Stated, _stated('N/m', 'positive')]
    law: Literal['hunt_crossley', 'spring_damper'] = 'hunt_crossley'
    damping: str = ''  # its unit depends on the law
    position: Annotated[Stated, _stated('rad')] = Stated(0.0)
    enabled: Switch = True


class ControlSection(Section):
    """How often the controllers run."""

    rate: str = ''
    period: Annotated[float, _quantity('s', 'positive')] | None = None


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
    joint_sensors: dict[Name, EncoderSection] = {}
    shaft_sensors: dict[Name, ShaftSensorSection] = {}
    load_cell: LoadCellSection | None = None
    control: ControlSection = ControlSection()
    effects: list[EffectSection] = []
