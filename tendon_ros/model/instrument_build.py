"""From the sections of an instrument file to the instrument: names resolved and checked."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import replace
import math

from tendon_ros.base.errors import EffectError, InstrumentError
from tendon_ros.base.quantity import parsed
from tendon_ros.base.recording import channel_name
from tendon_ros.model.effect_use import checked_use, units_at
from tendon_ros.model.instrument import (
    Contact,
    Controller,
    Coupling,
    Curve,
    EffectUse,
    Instrument,
    Loop,
    Motor,
    Pulley,
    Sensor,
)
from tendon_ros.model.instrument_check import check_references
from tendon_ros.model.instrument_schema import (
    ContactSection,
    ControlSection,
    CurveSection,
    EffectSection,
    EncoderSection,
    InstrumentSection,
    LoopSection,
    MotorSection,
    Section,
)
from tendon_ros.model.tolerance import GUESSED, read_stated, Stated, without_tolerance


def built(file: InstrumentSection) -> Instrument:
    """
    Return the instrument that a file describes.

    :param file: the file's sections, each sound in itself.
    :return: the instrument, order of everything as in the file.
    :raises InstrumentError: where sections do not fit together; the message begins with the field.
    """
    curves = tuple(curve(name, section) for name, section in file.curves.items())
    check_references(file)
    period, continuous = _control(file.control)
    bare = Instrument(
        name=file.name,
        description=file.description,
        pulleys=tuple(
            Pulley(n, p.inertia.value, p.damping.value) for n, p in file.pulleys.items()
        ),
        motors=tuple(_motor(name, section) for name, section in file.motors.items()),
        loops=tuple(_loop(name, section) for name, section in file.loops.items()),
        couplings=tuple(
            Coupling(n, dict(c.route), c.stiffness.value, c.damping.value)
            for n, c in file.couplings.items()
        ),
        curves=curves,
        contacts=tuple(_contact(name, section) for name, section in file.contacts.items()),
        sensors=tuple(_sensors(file)),
        control_period=period,
        continuous_control=continuous,
    )
    effects: list[EffectUse] = []
    tolerances = dict(_tolerances(file))
    for index, use in enumerate(file.effects):
        plain = {name: without_tolerance(text) for name, text in use.parameters.items()}
        try:
            effects.append(checked_use(bare, use.effect, use.place, plain))
            tolerances.update(_effect_tolerances(bare, use))
        except (EffectError, ValueError) as error:
            raise InstrumentError(f'effects.{index}: {error}') from None
    doubled = [pair for pair, n in Counter((e.effect, e.place) for e in effects).items() if n > 1]
    if doubled:
        raise InstrumentError(
            f'effects: {doubled[0][0]} at {doubled[0][1]} is given twice; keep one of the two'
        )
    return replace(bare, effects=tuple(effects), tolerances=tolerances)


def curve(name: str, section: CurveSection) -> Curve:
    """
    Return a curve whose points were checked.

    :param name: its name.
    :param section: its points.
    :return: the curve.
    :raises InstrumentError: where elongation does not increase, or tension is negative or falls.
    """
    x, t = section.elongation, section.tension
    field = f'curves.{name}'
    if len(x) != len(t) or len(x) < 2:
        raise InstrumentError(
            f'{field}: {len(x)} elongations for {len(t)} tensions; give at least two pairs'
        )
    for i in range(1, len(x)):
        if x[i] <= x[i - 1]:
            raise InstrumentError(
                f'{field}.elongation: point {i} ({x[i]:g} m) does not come after the one before '
                f'({x[i - 1]:g} m); sort the points'
            )
        if t[i] < t[i - 1]:
            raise InstrumentError(
                f'{field}.tension: falls to {t[i]:g} N at point {i} ({x[i]:g} m); smooth the test '
                'so that tension never falls with elongation'
            )
    if t[0] < 0.0 or t[-1] <= t[0]:
        raise InstrumentError(
            f'{field}.tension: goes from {t[0]:g} N to {t[-1]:g} N; a cable only pulls, and more '
            'with elongation'
        )
    return Curve(name, x, t)


def _motor(name: str, section: MotorSection) -> Motor:
    field = f'motors.{name}.position_limit'
    if len(section.position_limit) != 2 or section.position_limit[0] >= section.position_limit[1]:
        raise InstrumentError(f'{field}: give lower and upper, such as [-90 deg, 90 deg]')
    return Motor(
        name=name,
        pulley=section.pulley or name,
        controller=Controller(**section.controller.model_dump()) if section.controller else None,
        gear_ratio=section.gear_ratio,
        rotor_inertia=section.rotor_inertia,
        torque_limit=section.torque_limit,
        speed_limit=section.speed_limit,
        position_limit=(section.position_limit[0], section.position_limit[1]),
    )


def _loop(name: str, section: LoopSection) -> Loop:
    return Loop(
        name=name,
        route=dict(section.route),
        curve=section.curve,
        pretension=section.pretension.value,
        damping=section.damping.value,
        torque_sign={pulley: float(sign) for pulley, sign in section.torque_sign.items()},
    )


def _contact(name: str, section: ContactSection) -> Contact:
    return Contact(
        name=name,
        route=dict(section.route),
        arm=section.arm,
        stiffness=section.stiffness.value,
        damping=section.damping.value,
        position=section.position.value,
        law=section.law,
        enabled=section.enabled,
    )


def _tolerances(file: InstrumentSection) -> Iterator[tuple[str, float]]:
    places: list[tuple[str, Mapping[str, Section]]] = [
        ('pulley', file.pulleys),
        ('cable', file.loops),
        ('coupling', file.couplings),
        ('motor', file.motors),
        ('contact', file.contacts),
    ]
    for kind, sections in places:
        for name, section in sections.items():
            alone = kind == 'contact' and len(sections) == 1
            place = kind if alone else f'{kind}_{name}'
            for key in type(section).model_fields:
                stated = getattr(section, key)
                if isinstance(stated, Stated) and stated.tolerance is not None:
                    yield f'{place}.{key}', stated.tolerance


def _effect_tolerances(one: Instrument, use: EffectSection) -> Iterator[tuple[str, float]]:
    units = units_at(one, use.effect, use.place)
    for name, text in use.parameters.items():
        tolerance = read_stated(text, units[name]).tolerance
        if tolerance is not None:
            yield f'{use.place}.{use.effect}.{name}', tolerance


def _control(section: ControlSection) -> tuple[float, bool]:
    """Return the period of controllers or set-points [s], and whether the former have no ticks."""
    period = Instrument.control_period if section.period is None else section.period
    if section.rate in {'', 'continuous'}:
        return period, section.rate == 'continuous'
    if section.period is not None:
        raise InstrumentError('control: has both rate and period; keep one of them')
    try:
        rate = parsed(section.rate, 'Hz')
    except ValueError as error:
        raise InstrumentError(f'control.rate: {error}') from None
    if rate <= 0.0:
        raise InstrumentError("control.rate: must be positive; write '1 kHz' or 'continuous'")
    return 1.0 / rate, False


def _angle_sensor(name: str, channel: str, gear: float, section: EncoderSection) -> Sensor:
    counts = section.counts
    return Sensor(
        name=f'encoder_{name}',
        kind='angle',
        of=name,
        channel=channel,
        resolution=section.resolution if counts is None else 2.0 * math.pi / counts / gear,
        noise=section.noise,
        misfit=section.misfit,
    )


def _sensors(file: InstrumentSection) -> Iterator[Sensor]:
    for name, motor in file.motors.items():
        joint = motor.pulley or name
        position = channel_name('actuator', f'pulley_{joint}', 'position')
        yield _angle_sensor(joint, position, motor.gear_ratio, motor.encoder)
        yield Sensor(
            name=f'torque_{name}',
            kind='motor_torque',
            of=name,
            channel=channel_name('actuator', f'pulley_{joint}', 'effort'),
            resolution=motor.torque_sensor.resolution,
            noise=motor.torque_sensor.noise,
            misfit=motor.torque_sensor.misfit,
        )
    for name, encoder in file.joint_sensors.items():
        position = channel_name('pulley', f'pulley_{name}', 'position')
        plain = _angle_sensor(name, position, 1.0, encoder)
        yield replace(plain, zeroed=encoder.zero != GUESSED)
    driven = {motor.pulley or name for name, motor in file.motors.items()}
    for name, speed in file.speed_sensors.items():
        group = 'actuator' if name in driven else 'pulley'
        yield Sensor(
            name=f'speed_{name}',
            kind='velocity',
            of=name,
            channel=channel_name(group, f'pulley_{name}', 'velocity'),
            resolution=speed.resolution,
            noise=speed.noise,
            misfit=speed.misfit,
        )
    for name, shaft in file.shaft_sensors.items():
        yield Sensor(
            name=f'shaft_{name}',
            kind='loop_torque',
            of=name,
            through=shaft.through,
            channel=channel_name('pulley', f'pulley_{name}', 'effort'),
            resolution=shaft.resolution,
            noise=shaft.noise,
            misfit=shaft.misfit,
        )
    if file.load_cell is not None:
        cell = file.load_cell
        yield Sensor(
            name='load_cell',
            kind=f'contact_{cell.measures}',
            of=cell.contact or next(iter(file.contacts)),
            channel=channel_name('load_cell', '', cell.measures),
            resolution=cell.resolution,
            noise=cell.noise,
            misfit=cell.misfit,
        )
