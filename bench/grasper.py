"""
Diagnose runs of the da Vinci grasper, judge on all others: ``python -m bench.grasper FILE.npz``.

Trains on fifteen runs of three frequencies and every second load, or on ``--trained``, or takes
the instrument file of an earlier diagnosis, and says of the runs that it has not seen: the torque
of the spindle predicted from the jaw's torque and the motion; the jaw's torque and angle estimated
from the spindle, and from the motor alone, without and with knowing how fast the load changes.
With ``--tool`` the tool is looked at without its drive: the motion is that of its spindle.
Standard output is a table, a picture goes to ``--figure``.
"""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from itertools import product, repeat
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from tendon_ros.bags.importing import import_runs
from tendon_ros.bags.mapping import load_mapping
from tendon_ros.base.recording import Recording
from tendon_ros.base.resources import config_path
from tendon_ros.diagnose.intake import admitted
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.diagnose.session import diagnose
from tendon_ros.estimate import build_observer, estimate_recording
from tendon_ros.identify.segment import SETTLING
from tendon_ros.model.instrument import Instrument
from tendon_ros.model.instrument_file import load_instrument, save_instrument
from tendon_ros.model.laws import modified

FloatArray = NDArray[np.float64]

TRAINED = tuple(f'{speed}{load}' for speed in (0, 2, 4) for load in range(0, 10, 2))
EVERY = tuple(f'{speed}{load}' for speed in range(5) for load in range(10))
JAW = 'pulley/pulley_jaw/position'
LOAD = 'load_cell/torque'
RATE = 50.0  # [Hz] of what is compared: the motions are of half a hertz


@dataclass(frozen=True)
class Rig:
    """
    What is looked at.

    ``name``: of instrument file and mapping; ``ends``: from whose angle and torque the jaw is
    estimated, the spindle first.
    """

    name: str
    ends: Mapping[str, tuple[str, str]]

    @property
    def torque(self) -> str:
        """The channel of the spindle's torque."""
        return self.ends['spindle'][1]


WHOLE = Rig(
    'davinci_grasper',
    {
        'spindle': ('pulley/pulley_spindle/position', 'pulley/pulley_spindle/effort'),
        'motor': ('actuator/pulley_motor/position', 'actuator/pulley_motor/effort'),
    },
)
TOOL = Rig(
    'davinci_tool',
    {'spindle': ('actuator/pulley_input/position', 'pulley/pulley_spindle/effort')},
)


def predicted(
    run: Recording, instrument: Instrument, torque: str
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """
    Return times [s], a torque of a channel as measured and as the model has it [N m].

    All at ``RATE``: bins follow the speed, and every run counts by its length.
    """
    problem = prepared(admitted([run], instrument).recordings, instrument).whole
    [segment] = problem.rollouts.segments
    [rows] = problem.rollouts.predicted([[]])
    channels = [m.sensor.channel for m in segment.measured]
    at = channels.index(torque)
    time = np.arange(SETTLING, segment.time[-1], 1.0 / RATE)
    measured, model = (
        np.interp(time, segment.time, row) for row in (segment.measured[at].value, rows[at])
    )
    return time, measured, model


def wandered(runs: Sequence[Recording]) -> float:
    """Return by how much the load changes in a second [N m]: its deviation, over all runs."""
    parts = []
    for run in runs:
        time = np.arange(run.start + SETTLING, run[LOAD].time[-1] - 1.0, 1.0 / RATE)
        parts.append(run[LOAD].at(time + 1.0) - run[LOAD].at(time))
    return rms(parts)


def estimated(
    run: Recording, instrument: Instrument, channels: Sequence[str], wander: float | None
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """
    Return errors of jaw torque [N m] and angle [rad], and errors by the stated deviation.

    The torque is compared as the load cell would read it, whose zero the instrument may know.
    """
    observer = build_observer(instrument, 'static_balance', channels=channels, wander=wander)
    out = estimate_recording(run, observer, rate=RATE)
    time = out['estimate/torque'].time
    late = time > run.start + SETTLING
    numbers = modified(instrument, instrument.effects)
    cell = [s.channel for s in instrument.sensors].index(LOAD)
    read = numbers['sensor_gain'][cell] * out['estimate/torque'].value
    torque = read + numbers['sensor_offset'][cell] - run[LOAD].at(time)
    angle = out[f'estimate/{JAW.removeprefix("pulley/")}'].value - run[JAW].at(time)
    stated = torque / out['estimate/torque_std'].value
    return torque[late], angle[late], stated[late]


def rms(parts: Sequence[FloatArray]) -> float:
    """Return the root mean square of all parts together."""
    return float(np.sqrt(np.mean(np.concatenate(parts) ** 2)))


def main() -> None:
    """Diagnose, judge, print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[1])
    parser.add_argument('file', help='Tool_5_Maryland_L_3.npz, or another of its kind')
    parser.add_argument('--tool', action='store_true', help='the tool alone, without its drive')
    parser.add_argument('--instrument', help='of an earlier diagnosis, instead of a new one')
    parser.add_argument(
        '--trained', nargs='+', default=TRAINED, metavar='RUN', choices=EVERY,
        help='runs to diagnose, speed and load as two digits; all others judge',
    )  # fmt: skip
    parser.add_argument('--minutes', type=float, default=10.0, help='as of `tendon diagnose`')
    parser.add_argument('--out', type=Path, default=Path('out/grasper.yaml'), help='file to write')
    parser.add_argument('--figure', type=Path, help='picture to write')
    args = parser.parse_args()
    rig = TOOL if args.tool else WHOLE
    mapping = load_mapping(config_path(f'imports/{rig.name}.yaml'))
    runs = {run.name: run for run in import_runs(args.file, mapping, EVERY)}
    plain = load_instrument(rig.name)
    if args.instrument:
        found = load_instrument(args.instrument)
    else:
        outcome = diagnose(
            [runs[key] for key in args.trained],
            plain,
            plan=False,
            seconds=60.0 * args.minutes,
            report=lambda what, done: print(f'{done:4.0%} {what}', flush=True),
        )
        found = outcome.instrument
        args.out.parent.mkdir(parents=True, exist_ok=True)
        save_instrument(found, args.out)
        for cause in outcome.diagnosis.causes:
            same = ''.join(f' | {o.effect} {o.place}' for o in cause.indistinguishable)
            print(f'{cause.probability:.2f} {cause.effect} {cause.place}{same}')
        for cause in outcome.diagnosis.beside:
            print(f'beside: {cause.probability:.2f} {cause.effect} {cause.place}')
    held = [run for key, run in runs.items() if key not in args.trained]
    print(f'{len(held)} runs that no fit has seen')
    for name, instrument in (('file', plain), ('diagnosed', found)):
        off = [a - b for _, a, b in (predicted(run, instrument, rig.torque) for run in held)]
        print(f'{name:10} spindle torque from jaw torque and motion {1e3 * rms(off):6.2f} mN m')
    wander = wandered([runs[key] for key in args.trained])
    print(f'the load wanders by {1e3 * wander:.0f} mN m in a second, in the runs of the diagnosis')
    for known, (name, channels) in product((None, wander), rig.ends.items()):
        with ProcessPoolExecutor() as pool:
            rows = list(pool.map(estimated, held, repeat(found), repeat(channels), repeat(known)))
        inside = np.abs(np.concatenate([r[2] for r in rows])) < 1.96
        angle = [r[1] for r in rows]
        moving = [a - a.mean() for a in angle]  # the encoders' zeros jump between recordings
        told = f'{name} --wander' if known else name
        print(
            f'{told:16} jaw torque {1e3 * rms([r[0] for r in rows]):6.2f} mN m, jaw angle '
            f'{np.rad2deg(rms(moving)):5.2f} deg about the zero of its recording, '
            f'{np.rad2deg(rms(angle)):5.2f} deg with it, 95 % intervals hold {inside.mean():.0%}'
        )
    if args.figure:
        drawn(runs, ('14', '37'), (plain, found), rig.torque, args.figure)


def drawn(
    runs: dict[str, Recording],
    keys: Sequence[str],
    instruments: tuple[Instrument, Instrument],
    torque: str,
    path: Path,
) -> None:
    """Draw the spindle's torque of some runs, measured, by the file, and diagnosed."""
    import matplotlib

    matplotlib.use('Agg')
    from matplotlib import pyplot as plt

    figure, axes = plt.subplots(len(keys), 1, figsize=(9, 2.6 * len(keys)), sharex=True)
    for axis, key in zip(np.atleast_1d(axes), keys, strict=True):
        for name, instrument in zip(('instrument file', 'diagnosed'), instruments, strict=True):
            time, measured, model = predicted(runs[key], instrument, torque)
            if name == 'instrument file':
                axis.plot(time, 1e3 * measured, color='black', linewidth=1.6, label='measured')
            axis.plot(time, 1e3 * model, linewidth=1.0, label=name)
        axis.set_ylabel(f'run {key} [mN m]')
    place = {'loc': 'lower right', 'bbox_to_anchor': (1.0, 1.0), 'frameon': False}
    np.atleast_1d(axes)[0].legend(ncols=3, **place)
    np.atleast_1d(axes)[-1].set_xlabel('time [s]')
    figure.suptitle(
        'Spindle torque from jaw torque and motion', x=0.02, horizontalalignment='left'
    )
    figure.tight_layout()
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=110)


if __name__ == '__main__':
    main()
