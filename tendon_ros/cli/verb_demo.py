"""``tendon demo``: the paper's experiment live, its figures, a real tool, the paper's story."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tendon_ros.report.demo_page import LiveRig, RealTool

HELP = "run the rig live over ROS 2, reproduce the paper, and diagnose its rig's gap"

INSTRUMENT = 'paper_rig'
METHOD = 'dynamic'
#: the trajectory and its smooth approach [s]
SPAN = 19.0
#: estimates a second on the real tool, whose motion is below 1 Hz
TOOL_RATE = 50.0
TOOL_CHANNELS = ('pulley/pulley_spindle/position', 'pulley/pulley_spindle/effort')
#: a run of middle speed and load, to be looked at
SHOWN = '25'


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """
    Declare the arguments.

    :param parser: of this verb.
    """
    parser.add_argument('--out', required=True, metavar='DIR', help='folder for everything')
    parser.add_argument(
        '--grasper',
        metavar='FILE.npz',
        help='recordings of the da Vinci grasper: the published runs, one array each',
    )


def run(args: argparse.Namespace) -> None:
    """
    Run everything.

    :param args: parsed arguments.
    """
    from tendon_ros.base.errors import RecordingError
    from tendon_ros.cli.progress import shown
    from tendon_ros.cli.story_session import tell
    from tendon_ros.report.demo_page import write_demo_page
    from tendon_ros.report.paper_page import reproduce

    if args.grasper is not None and not Path(args.grasper).is_file():
        raise RecordingError(f'--grasper {args.grasper}: no such file')
    out = Path(args.out)
    print(
        '1. The rig live: simulator, estimator, recorder and trajectory as processes', flush=True
    )
    rig = _live(out / 'live')
    print(
        f'   force RMSE {rig.score.rmse:.3f} N of {rig.score.span:.1f} N; {rig.shared} of '
        f'{rig.measured} measurements got an estimate; live and offline differ by at most '
        f'{rig.offline_difference:.2g} N'
    )
    print('2. The figures of the paper', flush=True)
    with shown('reproducing') as progress:
        statements = reproduce(out / 'paper', lambda _, done: progress(done))
    print(f'   {sum(s.holds for s in statements)} of {len(statements)} statements hold')
    tool = None
    if args.grasper is not None:
        print('3. A real da Vinci grasper, frictionless model', flush=True)
        tool = _real(Path(args.grasper))
        for name, score in tool.scores.items():
            print(f'   run {name}: jaw torque RMSE {1e3 * score.rmse:6.1f} mN m')
        print(
            f'   all runs: {1e3 * tool.overall:.1f} mN m at the jaw, '
            f'{1e3 * tool.ratio * tool.overall:.1f} mN m in terms of spindle torque'
        )
    else:
        print('3. No recording of a real tool given (--grasper FILE.npz)')
    page = out / 'index.html'
    write_demo_page(page, rig, tool)
    print(f'   {page}')
    print("4. The paper's story, by machine: a rig that is not as its file says", flush=True)
    print(f'Look at {tell(out / "story")} and {page}')


def _live(folder: Path) -> LiveRig:
    """Run and record the rig; compare live, offline and load cell."""
    import numpy as np

    from tendon_ros.bags.reader import read_recording
    from tendon_ros.bags.stamps import to_stamps
    from tendon_ros.base.errors import RecordingError
    from tendon_ros.cli.progress import shown
    from tendon_ros.cli.rig_session import record_rig
    from tendon_ros.estimate import build_observer, estimate_recording
    from tendon_ros.estimate.score import scored
    from tendon_ros.model.instrument_file import load_instrument
    from tendon_ros.report.demo_page import LiveRig

    with shown('running') as progress:
        bag = record_rig(folder, INSTRUMENT, METHOD, progress, SPAN)
    recording = read_recording(bag)
    with shown('analysing') as progress:
        instrument = load_instrument(INSTRUMENT)
        observer = build_observer(instrument, METHOD)
        again = estimate_recording(recording, observer, progress)['estimate/force']
    score = scored(recording, instrument)
    if score is None:
        raise RecordingError(f'{bag}: no live estimates; see the logs beside it')
    live = recording['estimate/force']
    ours, theirs = (to_stamps(c.time, recording.epoch_ns) for c in (again, live))
    _, i, j = np.intersect1d(ours, theirs, return_indices=True)
    difference = float(np.max(np.abs(again.value[i] - live.value[j])))
    return LiveRig(recording, score, difference, len(j), len(recording['load_cell/force'].time))


def _real(path: Path) -> RealTool:
    """Estimate the jaw torque of every recorded run."""
    from tendon_ros.bags.importing import import_runs, run_keys
    from tendon_ros.bags.mapping import load_mapping
    from tendon_ros.base.errors import RecordingError
    from tendon_ros.base.resources import config_path
    from tendon_ros.cli.progress import shown
    from tendon_ros.estimate import build_observer, estimate_recording
    from tendon_ros.estimate.score import Score, scored
    from tendon_ros.model.instrument_file import load_instrument
    from tendon_ros.report.demo_page import RealTool

    mapping = load_mapping(config_path('imports/davinci_grasper.yaml'))
    grasper = load_instrument('davinci_grasper')
    keys = run_keys(path, mapping)
    scores: dict[str, Score] = {}
    looked_at = None
    with shown('estimating') as progress:
        for n, recording in enumerate(import_runs(path, mapping)):
            observer = build_observer(grasper, 'static_balance', channels=TOOL_CHANNELS)
            estimated = estimate_recording(recording, observer, rate=TOOL_RATE)
            score = scored(estimated, grasper)
            if score is None:
                raise RecordingError(f'{path}: run {recording.name} has no jaw torque')
            scores[recording.name] = score
            if looked_at is None or recording.name == SHOWN:
                looked_at = estimated
            progress((n + 1) / len(keys))
    if looked_at is None:
        raise RecordingError(f'{path}: no runs in it')
    spindle, drum = grasper.loops[0].route.values()
    return RealTool(scores, looked_at, abs(spindle / drum))
