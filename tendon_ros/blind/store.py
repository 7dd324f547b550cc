"""
A benchmark on disk: cases as bags, and their labels apart.

The folders in ``cases/case_0000`` are bags, ``instrument.yaml`` is what a user knows,
``withhold.json`` says which effects a run has to do without, ``labels/case_0000.json`` is read by
the scorer only. What a folder was made of stands in ``made.json``.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from concurrent.futures import as_completed, ProcessPoolExecutor
from dataclasses import asdict, replace
import json
import multiprocessing
from multiprocessing.connection import wait
import os
from pathlib import Path
import threading
from typing import Any

from tendon_ros.bags.reader import read_recording
from tendon_ros.bags.writer import write_recording
from tendon_ros.base.errors import RecordingError
from tendon_ros.base.recording import Recording
from tendon_ros.blind.bench import nominal
from tendon_ros.blind.case import Case, made, Settings
from tendon_ros.model.instrument_file import save_instrument

#: seeds from here on are for scores that are published; below, for development
PUBLISHED = 1000

Progress = Callable[[float], None]


def seed_kind(seed: int) -> str:
    """
    Return what a seed is for.

    :param seed: of a benchmark.
    :return: ``development`` or ``published``.
    """
    return 'published' if seed >= PUBLISHED else 'development'


def make(
    folder: Path,
    seed: int,
    cases: int,
    settings: Settings,
    *,
    jobs: int = 1,
    progress: Progress | None = None,
) -> None:
    """
    Write a benchmark; cases that are there already are kept, so that it goes on after a stop.

    :param folder: where to.
    :param seed: of the benchmark.
    :param cases: how many.
    :param settings: what they are like.
    :param jobs: processes.
    :param progress: called with the part that is done.
    :raises RecordingError: where the folder holds another benchmark.
    """
    asked = json.loads(json.dumps({'seed': seed, **asdict(settings)}))
    about = folder / 'made.json'
    if about.is_file():
        if read_json(about) != asked:
            raise RecordingError(
                f'{about}: is of other settings or another seed; give an empty folder'
            )
    else:
        folder.mkdir(parents=True, exist_ok=True)
        save_instrument(nominal(settings.bench), folder / 'instrument.yaml')
        write_json(about, asked)
    (folder / 'labels').mkdir(exist_ok=True)
    todo = [n for n in range(cases) if not label_path(folder, f'case_{n:04d}').is_file()]
    each(_make_one, [(folder, seed, n, settings) for n in todo], jobs, progress)
    withheld = {}
    for path in sorted((folder / 'labels').glob('case_*.json')):
        label = read_json(path)
        if label['withhold']:
            withheld[path.stem] = label['withhold']
    write_json(folder / 'withhold.json', withheld)


def _make_one(folder: Path, seed: int, index: int, settings: Settings) -> None:
    write_case(folder, made(seed, index, settings))


def write_case(folder: Path, case: Case) -> None:
    """
    Write one case, its label last, so that a case with a label is whole.

    :param folder: of the benchmark.
    :param case: the case.
    """
    for kind, recording in case.recordings.items():
        write_recording(recording, folder / 'cases' / case.name / kind, overwrite=True)
    label = {**case.label, 'withhold': list(case.withhold)}
    write_json(label_path(folder, case.name), label)


def label_path(folder: Path, case: str) -> Path:
    """Return where the label of a case is."""
    return folder / 'labels' / f'{case}.json'


def case_names(folder: Path) -> list[str]:
    """
    Return the cases of a benchmark.

    :param folder: of the benchmark.
    :return: their names in order.
    :raises RecordingError: where there are none.
    """
    names = sorted(path.name for path in (folder / 'cases').glob('case_*') if path.is_dir())
    if not names:
        raise RecordingError(f'{folder}: holds no cases; make some with `tendon blind make`')
    return names


def read_case(folder: Path, case: str) -> list[Recording]:
    """
    Return the recordings of a case, without its label.

    :param folder: of the benchmark.
    :param case: its name.
    :return: in the order of their names.
    """
    bags = sorted(path for path in (folder / 'cases' / case).iterdir() if path.is_dir())
    return [replace(read_recording(bag), name=bag.name) for bag in bags]


def read_json(path: Path) -> Any:
    """
    Return what a JSON file holds.

    :param path: the file.
    :return: its content.
    :raises RecordingError: where it cannot be read.
    """
    try:
        return json.loads(path.read_text(encoding='utf-8'))
    except (OSError, ValueError) as error:
        raise RecordingError(f'{path}: cannot be read ({error}); make it anew') from None


def write_json(path: Path, content: Mapping[str, Any] | list[Any]) -> None:
    """
    Write a JSON file, whole or not at all.

    :param path: the file.
    :param content: what it holds.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_suffix('.part')
    part.write_text(json.dumps(content, indent=1) + '\n', encoding='utf-8')
    part.replace(path)


def each(
    task: Callable[..., None],
    arguments: list[tuple[Any, ...]],
    jobs: int,
    progress: Progress | None,
) -> None:
    """
    Do a task for each of many arguments, in processes where more than one is asked for.

    :param task: a function of a module.
    :param arguments: for each call.
    :param jobs: processes.
    :param progress: called with the part that is done.
    """
    tell = progress or (lambda _: None)
    if jobs == 1:
        for done, given in enumerate(arguments):
            task(*given)
            tell((done + 1) / len(arguments))
        return
    context = multiprocessing.get_context('spawn')
    with ProcessPoolExecutor(jobs, mp_context=context, initializer=_end_with_parent) as pool:
        futures = [pool.submit(task, *given) for given in arguments]
        try:
            for done, future in enumerate(as_completed(futures)):
                future.result()
                tell((done + 1) / len(arguments))
        except BaseException:
            # leaving the pool waits for all that was asked for, which may take hours
            pool.shutdown(wait=False, cancel_futures=True)
            for worker in multiprocessing.active_children():
                worker.terminate()
            raise


def _end_with_parent() -> None:
    """End this process when the one that started it ends: who is killed can tell nobody."""
    parent = multiprocessing.parent_process()
    assert parent is not None
    thread = threading.Thread(target=_await_end, args=(parent.sentinel,), daemon=True)
    thread.start()


def _await_end(sentinel: int) -> None:
    wait([sentinel])
    os._exit(1)
