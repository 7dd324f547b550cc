"""The diagnosis on every case of a benchmark, without its labels."""

from __future__ import annotations

from collections.abc import Sequence
import importlib
import json
from pathlib import Path
import time
import traceback
from typing import Any

from tendon_ros.base.errors import TendonError
from tendon_ros.base.threads import use_one_thread
from tendon_ros.blind.store import case_names, each, Progress, read_case, read_json, write_json
from tendon_ros.diagnose.result import Diagnosis
from tendon_ros.model.instrument_file import load_instrument

#: what is judged: module and function
DIAGNOSE = 'tendon_ros.diagnose.session:diagnose'


def run(
    folder: Path,
    results: Path,
    *,
    jobs: int = 1,
    diagnose: str = DIAGNOSE,
    progress: Progress | None = None,
) -> dict[str, str]:
    """
    Diagnose every case that has no result yet, and write one file for each.

    :param folder: of the benchmark; its labels are not opened.
    :param results: where to write; cases with a result there are kept.
    :param jobs: processes, each with one thread for linear algebra.
    :param diagnose: what is judged, as ``module:function``.
    :param progress: called with the part that is done.
    :return: of the cases that were not diagnosed, what was said instead.
    """
    use_one_thread()
    withheld: dict[str, list[str]] = read_json(folder / 'withhold.json')
    todo = [case for case in case_names(folder) if not _done(results / f'{case}.json')]
    each(
        _run_one,
        [(folder, results, case, withheld.get(case, []), diagnose) for case in todo],
        jobs,
        progress,
    )
    said = {case: read_json(results / f'{case}.json') for case in case_names(folder)}
    return {case: content['error'] for case, content in said.items() if 'error' in content}


def _done(path: Path) -> bool:
    """Return whether there is a result that is not a failure."""
    return path.is_file() and 'diagnosis' in read_json(path)


def _run_one(
    folder: Path, results: Path, case: str, withhold: Sequence[str], diagnose: str
) -> None:
    module, _, name = diagnose.partition(':')
    function = getattr(importlib.import_module(module), name)
    recordings = read_case(folder, case)
    instrument = load_instrument(folder / 'instrument.yaml')
    began = time.perf_counter()
    content: dict[str, Any] = {}
    try:
        # cases run side by side, one thread each; the next experiment is not what is scored
        said = function(recordings, instrument, withhold=tuple(withhold), jobs=1, plan=False)
        diagnosis = said if isinstance(said, Diagnosis) else said.diagnosis
        content['diagnosis'] = json.loads(diagnosis.model_dump_json(by_alias=True))
    except TendonError as error:
        # what the diagnosis refuses, or fails at, is a wrong answer and not the end of the run
        content['error'] = str(error)
    except Exception:
        content['error'] = traceback.format_exc()
    content['seconds'] = round(time.perf_counter() - began, 3)
    write_json(results / f'{case}.json', content)
