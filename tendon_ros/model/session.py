"""A whole simulated experiment: an instrument along a trajectory, as a recording."""

from __future__ import annotations

from collections.abc import Callable
import math

from tendon_ros import __version__
from tendon_ros.base.errors import TrajectoryError
from tendon_ros.base.recording import Recording
from tendon_ros.model.instrument import Instrument
from tendon_ros.model.instrument_text import text_of
from tendon_ros.model.recorded import recording_of
from tendon_ros.model.rows import joined
from tendon_ros.model.simulation import Simulation
from tendon_ros.model.trajectory import check_limits, Trajectory

#: header stamp of time zero: ROS takes a stamp of zero for "not set" [ns]
FIRST_STAMP_NS = 1_000_000_000
#: ticks between two reports of progress
CHUNK = 500


def ticks_between(rate: float, period: float) -> int:
    """
    Return how many controller periods lie between two recorded rows.

    :param rate: rows per second [Hz].
    :param period: of the controllers [s].
    :return: a whole number.
    :raises TrajectoryError: where the rate does not divide that of the controllers.
    """
    ticks = round(1.0 / (rate * period)) if rate > 0.0 else 0
    if ticks < 1 or not math.isclose(ticks * period * rate, 1.0, rel_tol=1e-6):
        raise TrajectoryError(
            f'rate: {rate:g} Hz; give a rate that divides the {1.0 / period:g} Hz of the '
            f'controllers, such as {1.0 / period / 2:g}'
        )
    return ticks


def simulate(
    instrument: Instrument,
    trajectory: Trajectory,
    *,
    rate: float = 500.0,
    seed: int | None = None,
    engine: str = 'auto',
    progress: Callable[[float], None] | None = None,
) -> Recording:
    """
    Run an instrument along a trajectory, from rest where the trajectory begins.

    :param instrument: with the effects in force.
    :param trajectory: of all its motors, in any order.
    :param rate: recorded rows per second [Hz]; divides the controllers' rate.
    :param seed: of the sensors' noise; None leaves noise off.
    :param engine: ``auto``, ``compiled`` or ``plain``.
    :param progress: called now and then with the part that is done, 0 to 1.
    :return: what a rig would have recorded, and the inner truth besides.
    :raises TrajectoryError: on a trajectory beyond the instrument's limits, or of other motors.
    :raises SimulationError: where the simulation diverges.
    """
    check_limits(trajectory, instrument)
    period = instrument.control_period
    every = ticks_between(rate, period)
    # whoever writes a trajectory by hand need not know the order of the file
    setpoints = trajectory.ordered([m.name for m in instrument.motors]).sample(period)
    first = dict(zip(instrument.driven, setpoints[0], strict=True))
    simulation = Simulation(instrument, seed=seed, engine=engine, pose=first)
    parts = []
    for start in range(0, len(setpoints), CHUNK):
        parts.append(simulation.run(setpoints[start : start + CHUNK], every))
        if progress is not None:
            progress(min(1.0, (start + CHUNK) / len(setpoints)))
    return recording_of(
        joined(parts),
        setpoints[::every],
        name=f'{instrument.name}_{trajectory.name}',
        epoch_ns=FIRST_STAMP_NS,
        metadata={
            'trajectory': trajectory.name,
            'seed': 'noise off' if seed is None else str(seed),
            'engine': simulation.engine,
            'version': __version__,
            'instrument_yaml': text_of(instrument),
        },
    )
