"""
Where does what nothing explains lie? ``python -m bench.places --seeds 521 522 523``.

Makes development cases of the blind benchmark whose effect is in no catalogue or withheld, fits
the numbers of the file without any cause, and asks which place is to blame. Prints a line for
each case and what is right: the first place, and with those that no channel tells from it.
"""

from __future__ import annotations

import argparse

from bench.development import development, development_seed
from tendon_ros.blind.case import Case
from tendon_ros.diagnose.intake import admitted
from tendon_ros.diagnose.places import Places
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.diagnose.steps import Steps
from tendon_ros.diagnose.valleys import started

STRATA = ('unknown', 'withheld', 'unknown')


def blamed(case: Case) -> list[str]:
    """Return the first place, and those that no channel tells from it."""
    recordings = admitted(list(case.recordings.values()), case.instrument).recordings
    problem = prepared(recordings, case.instrument).problem
    places = Places(problem, started(Steps(problem, (), 1, lambda _what, _done: None)))
    return [name for one in places.shares(most=1) for name in (one.place, *one.same)]


def main() -> None:
    """Make the cases, ask, count."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[1])
    parser.add_argument('--seeds', nargs='+', type=development_seed, required=True)
    parser.add_argument('--cases', type=int, default=30, help='of each seed')
    args = parser.parse_args()
    cases = [(seed, index) for seed in args.seeds for index in range(args.cases)]
    first = among = 0
    for seed, index in cases:
        case = development(seed, index, STRATA)
        [effect] = case.label['effects']
        places = blamed(case)
        first += places[:1] == [effect['place']]
        among += effect['place'] in places
        told = f'{effect["effect"]} at {effect["place"]}'
        print(f'{seed}/{index} {case.label["channels"]}: {told}: {", ".join(places)}', flush=True)
    print(f'{len(cases)} cases, first {first}, with what no channel tells from it {among}')


if __name__ == '__main__':
    main()
