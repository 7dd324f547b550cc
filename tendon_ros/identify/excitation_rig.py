"""What a rig does with a motion under its own controllers, and how large the motion may be."""

from __future__ import annotations

from dataclasses import replace
import math

import numpy as np

from tendon_ros.base.errors import SimulationError, TrajectoryError
from tendon_ros.identify.excitation_channel import RATE
from tendon_ros.identify.excitation_motion import Motion
from tendon_ros.model.instrument import Controller, Instrument
from tendon_ros.model.numbers import Numbers
from tendon_ros.model.rows import Rows
from tendon_ros.model.simulation import Simulation
from tendon_ros.model.trajectory import check_limits, Trajectory

ACCURACY = 1e-6  # [rad] a step
SAFE = 0.8  # part of a torque limit that an experiment may ask for
#: [rad/s] and damping ratio with which a motor is taken to follow whose controller is not known
USUAL, DAMPED = 2.0 * math.pi * 5.0, 0.7
WORKING = 0.75  # part of the tension to which a cable was tested that it may bear


def performed(instrument: Instrument, trajectory: Trajectory) -> tuple[Rows, float]:
    """
    Return what a noiseless rig does under its own controllers, or usual ones.

    :param instrument: the rig.
    :param trajectory: its set-points.
    :return: rows and the time between them [s].
    :raises SimulationError: where it diverges.
    """
    every = max(1, round(1.0 / (RATE * instrument.control_period)))
    simulation = Simulation(controlled(instrument), tolerance=ACCURACY)
    wished = trajectory.sample(instrument.control_period)
    run = simulation.follow if instrument.continuous_control else simulation.run
    return run(wished, every), every * instrument.control_period


def controlled(instrument: Instrument) -> Instrument:
    """
    Return an instrument of which all motors follow a command.

    :param instrument: the network.
    :return: the same, with a usual controller where the file has none.
    """
    inertia = Numbers(instrument)['inertia']
    motors = []
    for motor in instrument.motors:
        stiff = float(inertia[instrument.index(motor.pulley)]) * USUAL**2
        usual = Controller(kp=stiff, kd=2.0 * DAMPED * stiff / USUAL)
        motors.append(replace(motor, controller=motor.controller or usual))
    return replace(instrument, motors=tuple(motors))


def fitting(instrument: Instrument, motion: Motion) -> Motion | None:
    """
    Return a motion made small enough for motors and cables.

    :param instrument: limits of position, speed and torque; cables by the range of their curves.
    :param motion: as large as it may be.
    :return: the motion, or None where it is too much at any size worth having.
    """
    curves = {c.name: c for c in instrument.curves}
    bearable = [WORKING * curves[loop.curve].tension[-1] for loop in instrument.loops]
    bearable += [np.inf] * len(instrument.couplings)
    torque = [SAFE * m.largest for m in instrument.motors]
    base = touching(instrument, motion)
    for _ in range(5):
        trajectory = motion.trajectory(instrument.motor_names)
        try:
            check_limits(trajectory, instrument)
            rows, _ = performed(base, trajectory)
        except (TrajectoryError, SimulationError):
            motion = motion.scaled(0.5)
            continue
        asked = np.abs(rows.effort).max(axis=0) / torque
        borne = np.abs(rows.loop_force).max(axis=0, initial=0.0) / bearable
        excess = max(1.0, asked.max(initial=0.0), borne.max(initial=0.0))
        if excess == 1.0:
            return motion
        motion = motion.scaled(max(0.5, 0.95 / float(excess)))
    return None


def reaches(instrument: Instrument) -> dict[str, dict[str, float]]:
    """
    Return how far each motor moves each contact.

    :param instrument: the network.
    :return: for each contact, by motor, the way of the contact's coordinate for one radian.
    """
    angle = 0.02
    free = replace(
        plain(instrument), contacts=tuple(replace(c, enabled=False) for c in instrument.contacts)
    )
    found: dict[str, dict[str, float]] = {c.name: {} for c in instrument.contacts}
    for motor in instrument.motor_names if instrument.contacts else ():
        time = np.array([0.0, 0.5, 1.5])
        still = np.zeros(3)
        position = dict.fromkeys(instrument.motor_names, still)
        position[motor] = angle * np.array([0.0, 1.0, 1.0])
        rows, _ = performed(free, Trajectory('reach', time, position))
        for contact in instrument.contacts:
            way = sum(
                ratio * rows.angle[-1, free.index(pulley)]
                for pulley, ratio in contact.route.items()
            )
            found[contact.name][motor] = float(way) / angle
    return found


def plain(instrument: Instrument) -> Instrument:
    """
    Return an instrument without the counts and the noise of its sensors.

    :param instrument: the network.
    :return: the same, its sensors exact.
    """
    sensors = tuple(replace(s, resolution=0.0, noise=0.0) for s in instrument.sensors)
    return replace(instrument, sensors=sensors)


def touching(instrument: Instrument, motion: Motion) -> Instrument:
    """
    Return an exact instrument with the one contact that a motion is against.

    :param instrument: the network.
    :param motion: the motion.
    :return: the instrument.
    """
    contacts = tuple(replace(c, enabled=c.name == motion.against) for c in instrument.contacts)
    return replace(plain(instrument), contacts=contacts)
