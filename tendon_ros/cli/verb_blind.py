"""``tendon blind``: the benchmark on rigs that are not the model, with labels kept apart."""

from __future__ import annotations

import argparse
from pathlib import Path

HELP = 'make, run and score the blind benchmark of the diagnosis'

MOST = 0.1  # nuisance, relative: three deviations of a damping that is off by three times as much


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """
    Declare the arguments.

    :param parser: of this verb.
    """
    tasks = parser.add_subparsers(dest='task', metavar='TASK', required=True)
    make = tasks.add_parser('make', help='write cases, and their labels apart')
    make.add_argument('--out', type=Path, required=True, metavar='DIR')
    make.add_argument('--seed', type=int, required=True, help='below 1000: for development')
    make.add_argument('--cases', type=int, required=True, metavar='K')
    make.add_argument(
        '--bench', choices=('bench', 'other', 'axis', 'arm', 'guessed'), default='bench'
    )
    make.add_argument('--strata', nargs='+', metavar='NAME', help='to take in turn')
    make.add_argument(
        '--channels', nargs='+', metavar='SET', help='motor, force, joint; of axis and arm motor'
    )
    make.add_argument(
        '--nuisance', type=float, default=0.01, help=f'one sigma, relative; {MOST} at most'
    )
    make.add_argument('--jobs', type=int, default=1, help='processes')
    run_ = tasks.add_parser('run', help='diagnose every case, without its label')
    run_.add_argument('folder', type=Path, metavar='DIR')
    run_.add_argument('--out', type=Path, required=True, metavar='RESULTS')
    run_.add_argument('--jobs', type=int, default=1, help='processes')
    score = tasks.add_parser('score', help='compare the answers with the labels')
    score.add_argument('folder', type=Path, metavar='DIR')
    score.add_argument('results', type=Path, metavar='RESULTS')
    score.add_argument(
        '--with',
        dest='others',
        nargs=2,
        action='append',
        default=[],
        type=Path,
        metavar=('DIR', 'RESULTS'),
        help='another seed or bench to put together with it; can be given several times',
    )
    score.add_argument('--out', type=Path, metavar='FOLDER', help='for the page; RESULTS/score')


def run(args: argparse.Namespace) -> None:
    """
    Do one of the tasks.

    :param args: parsed arguments.
    """
    {'make': _make, 'run': _run, 'score': _score}[args.task](args)


def _run(args: argparse.Namespace) -> None:
    from tendon_ros.blind.run import run as run_all
    from tendon_ros.cli.progress import shown

    _check('--jobs', args.jobs, 1)
    with shown('diagnosing') as progress:
        failed = run_all(args.folder, args.out, jobs=args.jobs, progress=progress)
    for case, error in failed.items():
        print(f'{case}: was not diagnosed: {error.strip().splitlines()[-1]}')
    print(f'{args.out}: score with `tendon blind score {args.folder} {args.out}`')


def _score(args: argparse.Namespace) -> None:
    from tendon_ros.blind.score import score, together
    from tendon_ros.report.blind_page import score_markdown, write_scoreboard

    pairs = [(args.folder, args.results), *args.others]
    scored = together([score(folder, results) for folder, results in pairs])
    folder = args.out or args.results / 'score'
    write_scoreboard(scored, folder)
    print(score_markdown(scored))
    print(f'{folder}/scoreboard.html')


def _check(name: str, value: float, least: float, most: float | None = None) -> None:
    """Refuse a number that is too small or too large."""
    from tendon_ros.base.errors import RecordingError

    if value < least:
        raise RecordingError(f'{name} {value}: is too small; give {least} or more')
    if most is not None and value > most:
        raise RecordingError(f'{name} {value}: is too large; give {most} or less')


def _make(args: argparse.Namespace) -> None:
    from tendon_ros.base.errors import listed, RecordingError
    from tendon_ros.blind.case import Settings, STRATA
    from tendon_ros.blind.setup import channel_sets
    from tendon_ros.blind.store import make, seed_kind
    from tendon_ros.cli.progress import shown

    sets = channel_sets(args.bench)
    strata, channels = args.strata or Settings().strata, args.channels or sets
    for name, given, known in (
        ('--strata', strata, STRATA),
        ('--channels', channels, sets),
    ):
        for one in given:
            if one not in known:
                raise RecordingError(f'{name} {one}: does not exist; there are {listed(known)}')
    _check('--cases', args.cases, 1)
    _check('--seed', args.seed, 0)
    _check('--jobs', args.jobs, 1)
    _check('--nuisance', args.nuisance, 0.0, MOST)
    settings = Settings(args.bench, args.nuisance, tuple(strata), tuple(channels))
    with shown('making cases') as progress:
        make(args.out, args.seed, args.cases, settings, jobs=args.jobs, progress=progress)
    print(f'{args.out}: {args.cases} cases of seed {args.seed} ({seed_kind(args.seed)})')
