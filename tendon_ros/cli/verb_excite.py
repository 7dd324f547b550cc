"""``tendon excite``: the motion and the channel that would tell explanations apart."""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from math import isclose
from pathlib import Path
from typing import TYPE_CHECKING

from tendon_ros.cli.arguments import takes_instrument

if TYPE_CHECKING:
    from tendon_ros.diagnose.result import Diagnosis
    from tendon_ros.identify.excitation import Pair, Suggestion
    from tendon_ros.identify.excitation_trial import Explanation
    from tendon_ros.model.instrument import EffectUse, Instrument
    from tendon_ros.model.trajectory import Trajectory

HELP = 'find the motion that tells explanations apart, and write it as a trajectory'

#: groups of channels, by what their names begin with
GROUPS = {'motor': 'actuator/', 'load_cell': 'load_cell/', 'pulley': 'pulley/', 'all': ''}
#: motions that are shown for each channel
SHOWN = 3


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """
    Declare the arguments.

    :param parser: of this verb.
    """
    takes_instrument(parser)
    parser.add_argument(
        '--separate',
        nargs='+',
        default=[],
        metavar='EFFECT@PLACE',
        help='what to tell apart; one alone is told from nothing',
    )
    parser.add_argument(
        '--from',
        dest='diagnosis',
        type=Path,
        metavar='diagnosis.json',
        help='take sizes from a diagnosis; without --separate, also what it could not tell apart',
    )
    parser.add_argument(
        '--channels',
        default='motor',
        metavar='GROUP|NAME,...',
        help=f'what is recorded: {", ".join(GROUPS)} or names of channels; default motor',
    )
    parser.add_argument('--out', required=True, type=Path, metavar='FILE.csv', help='trajectory')
    parser.add_argument('--seconds', type=float, help='of the trajectory; default what is needed')
    parser.add_argument('--jobs', type=int, default=2, metavar='N', help='threads; default: 2')
    parser.add_argument('--overwrite', action='store_true', help='replace a file that is there')


def run(args: argparse.Namespace) -> None:
    """
    Print what each channel and motion would tell, and write the best motion.

    :param args: parsed arguments.
    :raises OutputError: where the file cannot be written.
    :raises TrajectoryError: where the time makes no motion.
    :raises EffectError: on what to tell apart.
    :raises RecordingError: on channels, threads or the diagnosis.
    """
    from tendon_ros.base.errors import RecordingError, TrajectoryError
    from tendon_ros.base.outputs import check_output
    from tendon_ros.cli.progress import shown
    from tendon_ros.identify.excitation import separating, together
    from tendon_ros.identify.excitation_motion import CYCLE
    from tendon_ros.model.instrument_file import find_instrument, load_instrument

    read = [find_instrument(args.instrument), *([args.diagnosis] if args.diagnosis else [])]
    check_output(args.out, read, overwrite=args.overwrite)
    if args.jobs < 1:
        raise RecordingError(f'--jobs {args.jobs}: give at least 1')
    if args.seconds is not None and not 0.0 < args.seconds <= 3600.0:
        raise TrajectoryError(f'--seconds: {args.seconds:g}; give more than 0 and at most 3600')
    instrument = load_instrument(args.instrument)
    measured = _measured(instrument, args.channels)
    instrument, pairs = _asked(instrument, args.separate, args.diagnosis)
    with shown('trying motions') as progress:
        found = separating(instrument, measured, pairs, jobs=args.jobs)
        progress(1.0)
    found = together(found)
    if not found:
        raise TrajectoryError(
            f'{instrument.name}: cannot perform any motion within its limits of position, speed '
            'and torque; widen them in the instrument file'
        )
    _print_table(found)
    best = found[0]
    needed = best.seconds if best.seconds < 1e9 else 10.0 * CYCLE
    seconds = args.seconds or needed
    trajectory = best.motion.trajectory(instrument.motor_names, max(1, round(seconds / CYCLE)))
    _write(trajectory, args.out)
    if best.seconds == float('inf'):
        print('\nnothing here decides; what comes nearest:')
    print(f'\n{best.do}')
    print(f'{args.out}: {trajectory.duration:g} s')


def _measured(instrument: Instrument, text: str) -> list[str]:
    """Return the channels that a user names, singly or by group."""
    from tendon_ros.base.errors import listed, RecordingError
    from tendon_ros.base.names import names_in

    names = [s.channel for s in instrument.sensors]
    found: list[str] = []
    for word in names_in(text) or [text]:
        if word not in GROUPS and word not in names:
            raise RecordingError(
                f'--channels: {instrument.name} has no {word!r}; give {listed(GROUPS)}, or some '
                f'of {listed(names)}'
            )
        if word in GROUPS:
            found += [n for n in names if n.startswith(GROUPS[word])]
        else:
            found.append(word)
    return list(dict.fromkeys(found))


def _asked(
    instrument: Instrument, words: Sequence[str], path: Path | None
) -> tuple[Instrument, list[Pair]]:
    """
    Return what is to be told apart, and the instrument with all other causes in force.

    A cause stands instead of what the file has of it. A repaired file has the causes already:
    those that are to be told apart are taken out of it.
    """
    from dataclasses import replace
    from itertools import combinations

    from tendon_ros.base.errors import EffectError
    from tendon_ros.diagnose.together import alone
    from tendon_ros.model.effect_use import in_force

    diagnosis = None if path is None else _read(path)
    fitted = {
        (c.effect, c.place): {name: p.value for name, p in c.parameters.items()}
        for c in (diagnosis.causes if diagnosis else ())
    }
    sets = [[_named(instrument, word) for word in words]] if words else []
    if diagnosis is not None and not words:
        sets = [
            [(c.effect, c.place), *((o.effect, o.place) for o in rivals)]
            for c in diagnosis.causes
            if (rivals := alone(diagnosis, c))
        ]
        # what is only likely is no cause, and its report may ask about it all the same
        asked_there = dict.fromkeys(e.separates for e in diagnosis.next_experiment)
        sets = sets or [[_named(instrument, f'{e}@{at}') for e, at in one] for one in asked_there]
    if not sets:
        where = f'{path}: leaves nothing to tell apart' if path else 'nothing to tell apart'
        raise EffectError(f'{where}; name some with --separate EFFECT@PLACE EFFECT@PLACE')
    asked = {name for names in sets for name in names}
    kept = [
        use
        for use in instrument.effects
        if (use.effect, use.place) not in asked
        or not _is_fitted(use, fitted.get((use.effect, use.place), {}))
    ]
    instrument = replace(instrument, effects=tuple(kept))
    pairs: list[Pair] = []
    for names in sets:
        explained = [_explanation(instrument, name, fitted) for name in names]
        if len(explained) == 1:
            pairs.append((explained[0], None))
        # a set of a diagnosis is about its cause; what a user names is told apart in all pairs
        pairs += [(a, b) for a, b in combinations(explained, 2) if words or a is explained[0]]
    others = [_explanation(instrument, name, fitted) for name in fitted if name not in asked]
    uses = [candidate.use(values) for candidate, values in others]
    return replace(instrument, effects=in_force(instrument.effects, uses)), pairs


def _is_fitted(use: EffectUse, values: Mapping[str, float]) -> bool:
    """Return whether an effect of the file has the sizes of a diagnosis."""
    return bool(values) and all(
        name in use.parameters and isclose(use.parameters[name], value)
        for name, value in values.items()
    )


def _named(instrument: Instrument, word: str) -> tuple[str, str]:
    """Return effect and place of ``EFFECT@PLACE``."""
    from tendon_ros.base.errors import EffectError
    from tendon_ros.effects import find
    from tendon_ros.model.instrument import EffectUse
    from tendon_ros.model.layout import arrays_of

    effect, at, place = word.partition('@')
    if not at:
        raise EffectError(f'--separate {word}: write EFFECT@PLACE, such as {word}@pulley_1')
    typical = dict(find(effect).typical)
    arrays_of(instrument, [EffectUse(effect, place, typical)])  # complains where it cannot act
    return effect, place


def _explanation(
    instrument: Instrument,
    name: tuple[str, str],
    fitted: dict[tuple[str, str], dict[str, float]],
) -> Explanation:
    """Return an effect with the size that was fitted, or else one that is not the file's."""
    from tendon_ros.identify.candidate import everyone

    channels = [s.channel for s in instrument.sensors]
    [candidate] = [c for c in everyone(instrument, channels) if (c.effect, c.place) == name]
    typical = {p.name: p.typical for p in candidate.parameters}
    return candidate, {**typical, **fitted.get(name, {})}


def _read(path: Path) -> Diagnosis:
    from pydantic import ValidationError

    from tendon_ros.base.errors import RecordingError
    from tendon_ros.diagnose.result import Diagnosis

    try:
        return Diagnosis.model_validate_json(path.read_text(encoding='utf-8'))
    except OSError as error:
        raise RecordingError(f'{path}: {error.strerror}; give a diagnosis.json') from None
    except (ValidationError, UnicodeDecodeError):
        raise RecordingError(f'{path}: is no diagnosis; give a diagnosis.json') from None


def _print_table(found: Sequence[Suggestion]) -> None:
    """Print the best motions for each channel that could be added."""
    from rich.console import Console
    from rich.table import Table

    table = Table('channel to add', 'motion', 'motors', 'swing', 'contact', box=None)
    table.add_column('seconds', justify='right')
    table.add_column('deviations', justify='right')
    for channel in dict.fromkeys(s.add_channel for s in found):
        own = [s for s in found if s.add_channel == channel][:SHOWN]
        for s in own:
            mount = ' (no sensor yet)' if s.status == 'missing' else ''
            seconds = f'{s.seconds:.0f}' if s.seconds < 1e9 else 'never'
            cells = (channel + mount or '-', s.motion.shape, *s.motion.settings.values())
            table.add_row(*cells, seconds, f'{s.deviations:.2f}')
    Console(width=140, highlight=False).print(table)


def _write(trajectory: Trajectory, path: Path) -> None:
    """Write a trajectory as the CSV that ``load_trajectory`` reads."""
    import numpy as np

    from tendon_ros.base.errors import OutputError

    # rounding leaves negative zeros, which adding zero takes away
    lines = [','.join(['time_s', *(f'{motor}_rad' for motor in trajectory.motors)])]
    for time, row in zip(
        trajectory.time, np.round(trajectory.at(trajectory.time), 8), strict=True
    ):
        lines.append(','.join([f'{time:.4f}', *(f'{angle:.8f}' for angle in row + 0.0)]))
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text('\n'.join(lines) + '\n', encoding='utf-8')
    except OSError as error:
        raise OutputError(f'{path}: {error.strerror}; give a path to write to') from None
