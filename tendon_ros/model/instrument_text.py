"""From the instrument to the text of its file: readable quantities that are read back exactly."""

from __future__ import annotations

import math
from typing import Any

import yaml

from tendon_ros.base.quantity import column_text, readable_unit, written
from tendon_ros.model.effect_use import units_at
from tendon_ros.model.instrument import (
    Contact,
    contact_place,
    Controller,
    Coupling,
    Curve,
    DAMPING_UNITS,
    EffectUse,
    Instrument,
    Loop,
    Motor,
    Pulley,
    Sensor,
)
from tendon_ros.model.tolerance import GUESSED, written_stated, written_tolerance

Document = dict[str, Any]


def text_of(instrument: Instrument) -> str:
    """
    Return the YAML of an instrument.

    :param instrument: the instrument; its sensors must be such as a file can describe.
    :return: the text, what has its default value left out.
    """
    return yaml.safe_dump(
        _document(instrument),
        sort_keys=False,
        allow_unicode=True,
        default_flow_style=None,
        width=99,
    )


def curve_text(curve: Curve, comment: str) -> str:
    """
    Return the YAML of a curve's own file.

    :param curve: the curve.
    :param comment: where it comes from; written above it.
    :return: the text.
    """
    above = ''.join(f'# {line}'.rstrip() + '\n' for line in comment.splitlines())
    return above + yaml.safe_dump(
        _curve(curve), sort_keys=False, default_flow_style=None, width=99
    )


def _curve(curve: Curve) -> Document:
    document: Document = {}
    for key, values, unit in (
        ('elongation', curve.elongation, 'm'),
        ('tension', curve.tension, 'N'),
    ):
        own = readable_unit(values, unit)
        document[key] = {own: [float(column_text(v, own, unit)) for v in values]}
    return document


def _document(one: Instrument) -> Document:
    sensors = {s.name: s for s in one.sensors}
    document: Document = {
        'name': one.name,
        'description': one.description,
        'pulleys': {p.name: _pulley(p, _Known(one, f'pulley_{p.name}')) for p in one.pulleys},
        'curves': {curve.name: _curve(curve) for curve in one.curves},
        'loops': {x.name: _loop(x, _Known(one, f'cable_{x.name}')) for x in one.loops},
        'couplings': {
            c.name: _coupling(c, _Known(one, f'coupling_{c.name}')) for c in one.couplings
        },
        'motors': {m.name: _motor(m, sensors, _Known(one, f'motor_{m.name}')) for m in one.motors},
        'contacts': {
            c.name: _contact(c, _Known(one, contact_place(one, c))) for c in one.contacts
        },
        'joint_sensors': {
            s.of: _encoder(s, 1.0) | ({} if s.zeroed else {'zero': GUESSED})
            for s in one.sensors
            if s.kind == 'angle' and s.of not in one.driven
        },
        'speed_sensors': {s.of: _reading(s, 'rad/s') for s in one.sensors if s.kind == 'velocity'},
        'shaft_sensors': {
            s.of: {'through': s.through, **_reading(s, 'N*m')}
            for s in one.sensors
            if s.kind == 'loop_torque'
        },
        'load_cell': _load_cell(sensors['load_cell']) if 'load_cell' in sensors else {},
        'control': _control(one),
        'effects': [_effect(one, use) for use in one.effects],
    }
    return {key: value for key, value in document.items() if value}


class _Known:
    """Writes the numbers of a place with what is said of how well they are known."""

    def __init__(self, one: Instrument, place: str) -> None:
        self._tolerances = one.tolerances
        self._place = place

    def number(self, key: str, value: float, unit: str, default: float | None = None) -> Document:
        """Return a quantity under its key; nothing for the default, unless more is said of it."""
        tolerance = self._tolerances.get(f'{self._place}.{key}')
        if value == default and tolerance is None:
            return {}
        return {key: written_stated(value, unit, tolerance)}

    def factor(self, key: str) -> Document:
        """Return the tolerance of a factor on numbers that stand elsewhere."""
        tolerance = self._tolerances.get(f'{self._place}.{key}')
        return {} if tolerance is None else {key: written_tolerance(tolerance)}


def _unless(default: float, **values: tuple[float, str]) -> Document:
    """Return quantities as text, without those that have the default value."""
    return {key: written(v, unit) for key, (v, unit) in values.items() if v != default}


def _pulley(pulley: Pulley, known: _Known) -> Document:
    return {
        **known.number('inertia', pulley.inertia, 'kg*m^2'),
        **known.number('damping', pulley.damping, 'N*m*s/rad', 0.0),
    }


def _coupling(coupling: Coupling, known: _Known) -> Document:
    return {
        'route': dict(coupling.route),
        **known.number('stiffness', coupling.stiffness, 'N*m/rad'),
        **known.number('damping', coupling.damping, 'N*m*s/rad', 0.0),
    }


def _loop(loop: Loop, known: _Known) -> Document:
    document: Document = {
        'route': {pulley: written(radius, 'm') for pulley, radius in loop.route.items()},
        'curve': loop.curve,
        **known.number('pretension', loop.pretension, 'N'),
        **known.number('damping', loop.damping, 'N*s/m', 0.0),
        **known.factor('stiffness'),
        **known.factor('hardening'),
    }
    if loop.torque_sign:
        document['torque_sign'] = {p: int(sign) for p, sign in loop.torque_sign.items()}
    return document


def _controller(gains: Controller) -> Document:
    return {
        'kp': written(gains.kp, 'N*m/rad'),
        'ki': written(gains.ki, 'N*m/(rad*s)'),
        'kd': written(gains.kd, 'N*m*s/rad'),
        'limit': written(gains.limit, 'N*m'),
        **({} if gains.derivative == 'error' else {'derivative': gains.derivative}),
    }


def _motor(motor: Motor, sensors: dict[str, Sensor], known: _Known) -> Document:
    document: Document = {
        'pulley': motor.pulley,
        'controller': _controller(motor.controller) if motor.controller else {},
        **({} if motor.gear_ratio == 1.0 else {'gear_ratio': motor.gear_ratio}),
        **_unless(0.0, rotor_inertia=(motor.rotor_inertia, 'kg*m^2')),
        **_unless(
            math.inf,
            torque_limit=(motor.torque_limit, 'N*m'),
            speed_limit=(motor.speed_limit, 'rad/s'),
        ),
        **known.factor('torque_gain'),
    }
    if all(map(math.isfinite, motor.position_limit)):
        document['position_limit'] = [written(limit, 'rad') for limit in motor.position_limit]
    encoder = sensors.get(f'encoder_{motor.pulley}')
    torque = sensors.get(f'torque_{motor.name}')
    document['encoder'] = _encoder(encoder, motor.gear_ratio) if encoder else {}
    document['torque_sensor'] = _reading(torque, 'N*m') if torque else {}
    return {key: value for key, value in document.items() if value != {}}


def _reading(sensor: Sensor, unit: str) -> Document:
    return _unless(
        0.0,
        resolution=(sensor.resolution, unit),
        noise=(sensor.noise, unit),
        misfit=(sensor.misfit, unit),
    )


def _encoder(sensor: Sensor, gear: float) -> Document:
    """Return an encoder, its resolution as counts where they give exactly that."""
    document = _reading(sensor, 'rad')
    if sensor.resolution:
        counts = round(2.0 * math.pi / gear / sensor.resolution)
        if counts and 2.0 * math.pi / counts / gear == sensor.resolution:
            del document['resolution']
            document = {'counts': counts, **document}
    return document


def _contact(contact: Contact, known: _Known) -> Document:
    return {
        'route': dict(contact.route),
        'arm': written(contact.arm, 'm'),
        **known.number('stiffness', contact.stiffness, 'N/m'),
        'law': contact.law,
        **known.number('damping', contact.damping, DAMPING_UNITS[contact.law], 0.0),
        **known.number('position', contact.position, 'rad', 0.0),
        **({} if contact.enabled else {'enabled': False}),
    }


def _load_cell(sensor: Sensor) -> Document:
    measures = sensor.kind.removeprefix('contact_')
    unit = 'N' if measures == 'force' else 'N*m'
    return {'contact': sensor.of, 'measures': measures, **_reading(sensor, unit)}


def _control(one: Instrument) -> Document:
    rate = 1.0 / one.control_period
    exact = 1.0 / rate == one.control_period
    if not one.continuous_control and exact:
        return {'rate': written(rate, 'Hz')}
    default = one.control_period == Instrument.control_period
    period = {} if default else {'period': written(one.control_period, 's')}
    return {'rate': 'continuous', **period} if one.continuous_control else period


def _effect(one: Instrument, use: EffectUse) -> Document:
    known, units = _Known(one, use.place), units_at(one, use.effect, use.place)
    parameters: Document = {}
    for name, value in use.parameters.items():
        unit = units.get(name, '1')
        [text] = known.number(f'{use.effect}.{name}', value, unit).values()
        # a number without unit or tolerance is written as one, not as text
        parameters[name] = value if unit == '1' and text == written(value, unit) else text
    return {'effect': use.effect, 'place': use.place, 'parameters': parameters}
