"""
Calibrates the probabilities of a diagnosis on development seeds of the blind benchmark.

``python -m bench.calibrate KEPT.jsonl --seeds 1 2 --cases 16`` diagnoses development cases in two
processes, keeps what speaks for each cause and whether it is true, and prints the weights of a
logistic regression for ``tendon_ros/diagnose/signs.py``. Cases that are kept already are not run
again, so that a campaign can be continued and enlarged.
"""

from __future__ import annotations

import argparse
from concurrent.futures import as_completed, ProcessPoolExecutor
from dataclasses import asdict
import json
from pathlib import Path
import sys
from typing import Any

import numpy as np
from scipy.optimize import minimize

from bench.development import development, development_seed
from tendon_ros.blind.case import PATTERN, STRATA
from tendon_ros.diagnose.session import diagnose
from tendon_ros.diagnose.signs import Signs

#: weights of a few dozen causes must not run away
RIDGE = np.array([0.0, 0.1, 0.1, 0.1])


def one(seed: int, index: int, strata: tuple[str, ...]) -> dict[str, Any]:
    """Diagnose one case, and say what spoke for each cause and whether it is true."""
    case = development(seed, index, strata)
    recordings = list(case.recordings.values())
    outcome = diagnose(recordings, case.instrument, withhold=case.withhold, jobs=1, plan=False)
    truth = {(e['effect'], e['place']) for e in case.label['effects']}
    rows = [
        {
            'cause': f'{w.cause.effect}@{w.cause.place}',
            'true': bool({(c.effect, c.place) for c in (w.cause, *w.equal)} & truth),
            'signs': asdict(w.signs),
        }
        for w in outcome.weighed
    ]
    return {'seed': seed, 'index': index, 'stratum': case.label['stratum'], 'causes': rows}


def weights(rows: list[dict[str, Any]]) -> np.ndarray:
    """Return the weights of a logistic regression of truth on the signs."""
    inputs = np.array([Signs(**r['signs']).features for r in rows])
    truth = np.array([r['true'] for r in rows], dtype=np.float64)

    def loss(w: np.ndarray) -> float:
        score = inputs @ w
        return float(np.sum(np.logaddexp(0.0, score) - truth * score) + RIDGE @ w**2)

    found: np.ndarray = minimize(loss, np.zeros(inputs.shape[1])).x
    return found


def main() -> None:
    """Run what is missing, then print the weights and how they do."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[1])
    parser.add_argument('kept', type=Path, help='file to read and to append to')
    parser.add_argument('--seeds', nargs='*', type=development_seed, default=[])
    parser.add_argument('--cases', type=int, default=len(PATTERN), help='of each seed')
    parser.add_argument('--strata', nargs='+', default=PATTERN, choices=STRATA)
    args = parser.parse_args()
    path, strata = args.kept, tuple(args.strata)
    kept = [json.loads(line) for line in path.read_text().splitlines()] if path.exists() else []
    known = {(k['seed'], k['index'], k['stratum']) for k in kept}
    todo = [
        (seed, index)
        for seed in args.seeds
        for index in range(args.cases)
        if (seed, index, strata[index % len(strata)]) not in known
    ]
    with ProcessPoolExecutor(2) as pool, path.open('a') as file:
        for future in as_completed([pool.submit(one, *case, strata) for case in todo]):
            kept.append(future.result())
            print(json.dumps(kept[-1]), file=file, flush=True)
            print(f'{len(kept)} cases', file=sys.stderr)
    rows = [r for k in kept for r in k['causes']]
    found = weights(rows)
    print('WEIGHTS =', np.round(found, 2).tolist())
    chance = 1.0 / (1.0 + np.exp(-np.array([Signs(**r['signs']).features for r in rows]) @ found))
    truth = np.array([r['true'] for r in rows])
    for low in np.arange(0.0, 1.0, 0.2):
        inside = (chance >= low) & (chance < low + 0.2 + 1e-9)
        if inside.any():
            said, held = chance[inside].mean(), truth[inside].mean()
            print(f'{low:.1f}-{low + 0.2:.1f}: {inside.sum()}, said {said:.2f}, true {held:.2f}')


if __name__ == '__main__':
    main()
