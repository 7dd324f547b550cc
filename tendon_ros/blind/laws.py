"""
The faults that a catalogue may have: where each can act, and how large it is drawn.

Sizes are drawn log-uniformly between bounds in which most make a gap that is plain to see. The
laws are this benchmark's own; see :mod:`tendon_ros.blind.law`.
"""

from __future__ import annotations

from collections.abc import Mapping

from tendon_ros.blind import drive_laws as drive
from tendon_ros.blind import pulley_laws as pulley
from tendon_ros.blind.law import at, Law

_ALL = at('pulley', 'M L 1 2 3')
_CABLES = at('cable', 'm1 12 L3')
_MOTORS = at('motor', 'M L')
_OUTER, _INNER = at('encoder', 'M L'), at('encoder', '1 2 3')
_CELL, _CONTACT = ('load_cell',), ('contact',)

#: every fault that a catalogue may have; an effect can have several, by where it acts
LAWS: tuple[Law, ...] = (
    Law('coulomb_friction', _ALL, 0.02, 0.5, pulley.coulomb),
    Law('tension_friction', _ALL, 0.03, 0.3, pulley.tension),
    Law('stribeck_friction', _ALL, 0.04, 0.4, pulley.stribeck),
    Law('presliding_friction', _ALL, 0.04, 0.5, pulley.presliding),
    Law('asymmetric_friction', _ALL, 0.03, 0.4, pulley.asymmetric),
    Law('viscous_friction', _ALL, 0.3, 6.0, pulley.viscous, spread=3.0),
    Law('pretension', _CABLES, 0.15, 0.8, drive.pretension, spread=1.0),
    Law('cable_stiffness', _CABLES, 0.06, 0.5, drive.stiffness, spread=1.0),
    Law('cable_hysteresis', _CABLES, 1.0, 9.0, drive.hysteresis),
    Law('cable_creep', _CABLES, 0.05, 0.4, drive.creep),
    Law('cable_slip', _CABLES, 8e-5, 6e-4, drive.slip, event=True),
    Law('backlash', _MOTORS, 1.5e-3, 2e-2, drive.backlash),
    Law('eccentricity', _ALL, 0.008, 0.1, pulley.eccentric),
    Law('inertia', at('pulley', '3'), 0.15, 1.2, pulley.inertia, spread=1.0),
    Law('inertia', at('pulley', 'M L 1 2'), 0.7, 2.9, pulley.inertia, spread=1.0),
    Law('gravity', at('pulley', '2 3'), 0.04, 0.6, pulley.gravity),
    Law('joint_spring', at('pulley', '1 2 3'), 0.15, 4.0, pulley.spring),
    Law('torque_gain', _MOTORS, 0.03, 0.25, drive.torque_gain),
    Law('torque_bias', _MOTORS, 0.03, 0.3, drive.torque_bias),
    Law('torque_ripple', _MOTORS, 0.03, 0.3, drive.ripple),
    Law('torque_saturation', _MOTORS, 1.0, 5.0, drive.saturation),
    Law('encoder_offset', _OUTER, 2e-3, 2.5e-2, drive.encoder_offset),
    Law('encoder_offset', _INNER, 4e-4, 2e-2, drive.encoder_offset),
    Law('encoder_gain', _OUTER, 0.01, 0.1, drive.encoder_gain),
    Law('encoder_gain', _INNER, 0.005, 0.1, drive.encoder_gain),
    Law('sensor_delay', _OUTER, 1e-3, 1.2e-2, drive.encoder_delay),
    Law('sensor_delay', _INNER, 1.5e-3, 3e-2, drive.encoder_delay),
    Law('sensor_delay', at('torque', 'M L'), 4e-3, 4.5e-2, drive.torque_delay),
    Law('sensor_delay', _CELL, 4e-3, 4.5e-2, drive.cell_delay),
    Law('sensor_rectified', at('torque', 'M L'), 0.99, 1.01, drive.rectified),
    Law('load_cell_gain', _CELL, 0.015, 0.25, drive.cell_gain),
    Law('load_cell_bias', _CELL, 0.15, 2.5, drive.cell_bias),
    Law('contact_stiffness', _CONTACT, 0.3, 2.0, drive.contact_stiffness, spread=1.0),
    Law('contact_position', _CONTACT, 5e-4, 8e-3, drive.contact_position),
    Law('disturbance', _ALL, 0.08, 1.2, pulley.disturbance, event=True),
)

_M, _MOTOR_M = ('pulley_M',), ('motor_M',)

#: the same of one body on a motor: inertia and damping are guessed there, and no faults; another
#: torque constant is the same as more of both
AXIS_LAWS: tuple[Law, ...] = (
    Law('coulomb_friction', _M, 0.02, 0.5, pulley.coulomb),
    Law('stribeck_friction', _M, 0.04, 0.4, pulley.stribeck),
    Law('presliding_friction', _M, 0.04, 0.5, pulley.presliding),
    Law('asymmetric_friction', _M, 0.03, 0.4, pulley.asymmetric),
    Law('gravity', _M, 0.04, 0.6, pulley.gravity),
    Law('joint_spring', _M, 0.05, 1.0, pulley.spring),
    Law('torque_bias', _MOTOR_M, 0.03, 0.3, drive.torque_bias),
    Law('torque_ripple', _MOTOR_M, 0.03, 0.3, drive.ripple),
    Law('torque_saturation', _MOTOR_M, 1.5, 6.0, drive.saturation),
    Law('sensor_delay', at('encoder', 'M'), 1e-3, 1.2e-2, drive.encoder_delay),
    Law('sensor_delay', at('torque', 'M'), 4e-3, 4.5e-2, drive.torque_delay),
    Law('sensor_rectified', at('torque', 'M'), 0.99, 1.01, drive.rectified),
    Law('disturbance', _M, 0.08, 1.2, pulley.disturbance, event=True),
)

#: the same of a weight on a servo; the weight is in its file
ARM_LAWS: tuple[Law, ...] = (
    *(law for law in AXIS_LAWS if law.effect != 'gravity'),
    Law('tension_friction', _M, 0.05, 0.6, pulley.tension),
)

#: the same of the benches where inertias, dampings and cables are guessed: those, and what cannot
#: be told from them, are no faults
GUESSED_LAWS: tuple[Law, ...] = tuple(
    law
    for law in LAWS
    if law.effect
    not in {'inertia', 'viscous_friction', 'pretension', 'cable_stiffness', 'torque_gain'}
)

_DRY = ('coulomb_friction', 'stribeck_friction', 'presliding_friction', 'asymmetric_friction')
_CONSTANT = ('torque_bias', 'gravity', 'joint_spring', 'disturbance')
_SHIFT = ('encoder_offset', 'contact_position', 'cable_slip')
_SOFT = ('pretension', 'cable_stiffness')
_SCALE = ('encoder_gain', 'eccentricity')

#: effects that are one on one body: a constant torque moves the rest of a spring, and makes
#: friction differ by direction
MERGING = ({'torque_bias', 'joint_spring'}, {'torque_bias', 'asymmetric_friction'})

#: effects of a catalogue that hold each other as a special case: one is taken out with the others,
#: or the catalogue would still be able to explain what is withheld
KIN: Mapping[str, tuple[str, ...]] = {
    effect: kin for kin in (_DRY, _CONSTANT, _SHIFT, _SOFT, _SCALE) for effect in kin
} | {'disturbance': ('disturbance',), 'cable_slip': ('cable_slip',)}
