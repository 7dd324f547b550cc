"""``tendon diagnose``: where the gap to the model lies, what causes it, how far it shrinks."""

from __future__ import annotations

import argparse
from pathlib import Path
import sys

from tendon_ros.cli.arguments import files_read, recordings_of, takes_bags, takes_stretches

HELP = 'say where the gap between recordings and model lies, and which effect causes it'


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """
    Declare the arguments.

    :param parser: of this verb.
    """
    takes_bags(parser)
    takes_stretches(parser)
    parser.add_argument(
        '--out',
        required=True,
        metavar='DIR',
        help='folder for report.html, diagnosis.json and instrument.yaml',
    )
    parser.add_argument(
        '--withhold',
        action='append',
        default=[],
        metavar='EFFECT[@PLACE]',
        help='do without this effect; can be given several times',
    )
    parser.add_argument('--jobs', type=int, metavar='N', help='threads; default: one a core')
    parser.add_argument(
        '--minutes',
        type=float,
        metavar='M',
        help='that it may take on two cores, about: the search for causes is cut short for that, '
        'counted in steps of the model so that another run comes as far; 0: no limit; default: 10',
    )
    parser.add_argument(
        '--overwrite',
        action='store_true',
        help='replace files that no earlier diagnosis wrote, too',
    )


def run(args: argparse.Namespace) -> None:
    """
    Diagnose, write what was found, and say it.

    :param args: parsed arguments.
    """
    import math
    import os

    from tendon_ros.base.errors import RecordingError
    from tendon_ros.base.outputs import check_output
    from tendon_ros.cli.progress import told
    from tendon_ros.diagnose.memory import Memory
    from tendon_ros.diagnose.patience import USUAL
    from tendon_ros.diagnose.session import diagnose
    from tendon_ros.identify.candidate import check_withheld
    from tendon_ros.model.instrument_file import load_instrument, save_instrument
    from tendon_ros.model.joints import joint_names
    from tendon_ros.report.diagnosis_page import diagnosis_page
    from tendon_ros.report.diagnosis_text import summary
    from tendon_ros.report.page import write

    jobs = args.jobs if args.jobs is not None else os.cpu_count() or 1
    if jobs < 1:
        raise RecordingError(f'--jobs {jobs}: give at least 1')
    if args.minutes is not None and not args.minutes >= 0.0:
        raise RecordingError(f'--minutes {args.minutes:g}: give a time, or 0 for no limit')
    folder = Path(args.out)
    read, replaced = files_read(args), args.overwrite or _diagnosed(folder)
    for name in WRITTEN:
        check_output(folder / name, read, overwrite=replaced)
    instrument = load_instrument(args.instrument)
    check_withheld(instrument, args.withhold)
    recordings = recordings_of(args, joint_names(instrument))
    folder.mkdir(parents=True, exist_ok=True)
    memory = Memory(folder / 'unfinished.json', recordings, instrument, args.withhold)
    with told() as report:
        outcome = diagnose(
            recordings,
            instrument,
            withhold=args.withhold,
            jobs=jobs,
            report=report,
            memory=memory,
            seconds=USUAL if args.minutes is None else 60.0 * args.minutes or math.inf,
        )
    if memory.refused:
        print(
            f'warning: {folder / "unfinished.json"}: {memory.refused}; interrupted, this '
            'diagnosis would have begun anew',
            file=sys.stderr,
        )
    text = outcome.diagnosis.model_dump_json(by_alias=True, indent=2)
    write(folder / 'diagnosis.json', text + '\n')
    write(folder / 'report.html', diagnosis_page(outcome.diagnosis, outcome.evidence))
    memory.forget()
    save_instrument(outcome.instrument, folder / 'instrument.yaml')
    write(folder / 'README.txt', WHAT_IS_HERE)  # last, so that all that it names is there
    print(summary(outcome.diagnosis, outcome.evidence.moved))
    print(f'{folder / "report.html"}: the whole of it, with pictures')


def _diagnosed(folder: Path) -> bool:
    """Tell whether what lies in a folder comes from a diagnosis, finished or interrupted."""
    import json

    for name, keys in OWN.items():
        try:
            data = json.loads((folder / name).read_text(encoding='utf-8'))
        except (OSError, ValueError):
            continue
        if isinstance(data, dict) and keys <= data.keys():
            return True
    return False


#: what only a diagnosis leaves, and the keys by which it is known whatever version wrote it
OWN = {'diagnosis.json': {'schema', 'verdict', 'causes'}, 'unfinished.json': {'key', 'models'}}
#: all that it writes
WRITTEN = (*OWN, 'instrument.yaml', 'report.html', 'README.txt')
WHAT_IS_HERE = (
    'report.html: what was found, with pictures.\n'
    'diagnosis.json: the same for programs.\n'
    'instrument.yaml: the instrument file with the effects that were found, those that are only '
    'likely too where they hold on what no fit has seen; simulator, estimator and diagnose take '
    'it as it is.\n'
)
