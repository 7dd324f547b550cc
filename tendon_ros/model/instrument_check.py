"""References between the sections of an instrument file: every name that is used must exist."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from difflib import get_close_matches

from tendon_ros.base.errors import InstrumentError, listed
from tendon_ros.model.instrument_schema import (
    ContactSection,
    CouplingSection,
    InstrumentSection,
    LoopSection,
)


def check_references(file: InstrumentSection) -> None:
    """
    Check that all names in a file refer to something that fits.

    :param file: the file's sections, each sound in itself, as are its curves.
    :raises InstrumentError: on the first that does not; the message lists what exists.
    """
    for kind, empty in (('pulleys', not file.pulleys), ('motors', not file.motors)):
        if empty:
            raise InstrumentError(f'{kind}: is empty; an instrument has at least one')
    rows: dict[str, Mapping[str, LoopSection | CouplingSection | ContactSection]] = {
        'loops': file.loops,
        'couplings': file.couplings,
        'contacts': file.contacts,
    }
    for kind, sections in rows.items():
        for name, section in sections.items():
            field = f'{kind}.{name}.route'
            if not section.route:
                raise InstrumentError(f'{field}: is empty; name a pulley and its radius or ratio')
            for pulley in section.route:
                _known(field, pulley, 'pulley', file.pulleys)
    for name, loop in file.loops.items():
        _known(f'loops.{name}.curve', loop.curve, 'curve', file.curves)
        for pulley in loop.torque_sign:
            _known(f'loops.{name}.torque_sign', pulley, 'pulley of the route', loop.route)
        low, *_, high = file.curves[loop.curve].tension
        pretension = loop.pretension.value
        if not low <= pretension <= high:
            raise InstrumentError(
                f'loops.{name}.pretension: {pretension:g} N is outside of the curve '
                f'{loop.curve}, {low:g} to {high:g} N; choose a value inside'
            )
    _check_sensors(file)


def _check_sensors(file: InstrumentSection) -> None:
    driven: dict[str, str] = {}
    for name, motor in file.motors.items():
        pulley = motor.pulley or name
        _known(f'motors.{name}.pulley', pulley, 'pulley', file.pulleys)
        if pulley in driven:
            raise InstrumentError(
                f'motors.{name}.pulley: {pulley} is driven by motor {driven[pulley]} already; '
                'give each motor a pulley of its own'
            )
        driven[pulley] = name
    for pulley in file.joint_sensors:
        _known('joint_sensors', pulley, 'pulley', file.pulleys)
        if pulley in driven:
            raise InstrumentError(
                f'joint_sensors.{pulley}: the pulley has a motor; write its encoder into '
                f'motors.{driven[pulley]}.encoder'
            )
    for pulley in file.speed_sensors:
        _known('speed_sensors', pulley, 'pulley', file.pulleys)
    pulls: dict[str, LoopSection | CouplingSection] = {**file.loops, **file.couplings}
    for pulley, shaft in file.shaft_sensors.items():
        field = f'shaft_sensors.{pulley}'
        _known('shaft_sensors', pulley, 'pulley', file.pulleys)
        _known(f'{field}.through', shaft.through, 'loop or coupling', pulls)
        _known(f'{field}.through', pulley, 'pulley of its route', pulls[shaft.through].route)
    if file.load_cell is not None:
        if file.load_cell.contact:
            _known('load_cell.contact', file.load_cell.contact, 'contact', file.contacts)
        elif len(file.contacts) != 1:
            raise InstrumentError(
                f'load_cell: is missing `contact: NAME`; there are {listed(file.contacts)}'
            )


def _known(field: str, name: str, what: str, names: Iterable[str]) -> None:
    """Check that a name refers to something."""
    names = list(names)
    if name not in names:
        close = get_close_matches(name, names, n=1)
        hint = f', did you mean {close[0]!r}?' if close else ''
        raise InstrumentError(f'{field}: no {what} {name!r}{hint}; there are {listed(names)}')
