"""The score of a benchmark: rows by stratum and channel set, calibration, confusions."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
import math
from pathlib import Path
import statistics
from typing import Any

from tendon_ros.base.errors import RecordingError
from tendon_ros.blind.case import STRATA
from tendon_ros.blind.judge import FOREIGN, judged, Judgement, KNOWN
from tendon_ros.blind.sensing import CHANNEL_SETS
from tendon_ros.blind.statistics import Bin, calibration_error, Fraction, reliability
from tendon_ros.blind.store import label_path, read_json, seed_kind

EVERY = 'all'


@dataclass(frozen=True)
class Row:
    """One stratum with one channel set, or with all of them."""

    stratum: str
    channels: str
    cases: int
    verdict: Fraction
    right: Fraction
    uncertain: Fraction
    found: Fraction  # effects of all that there were
    true: Fraction  # causes of all that were named
    alarmed: Fraction  # cases with a wrong cause
    place: Fraction  # of what is not in the catalogue
    place_near: Fraction
    set_size: float  # mean
    left: float  # median of the rest of the gap by the floor
    inside: Fraction
    error: float  # median, relative
    seconds: float  # median


@dataclass(frozen=True)
class Score:
    """
    Everything about one run.

    ``confusion`` counts true and named effects; ``misses`` are cases that are not right.
    ``missing`` counts cases without a result.
    """

    about: dict[str, Any]
    rows: tuple[Row, ...]
    bins: tuple[Bin, ...]
    calibration_error: float
    confusion: tuple[tuple[str, str, int], ...]
    idle: tuple[float, ...]
    judgements: tuple[Judgement, ...]
    missing: int

    @property
    def misses(self) -> tuple[Judgement, ...]:
        """Cases that are not right."""
        return tuple(j for j in self.judgements if not j.right)


def score(folder: Path, results: Path) -> Score:
    """
    Score a run: the only place where labels are read.

    :param folder: of the benchmark.
    :param results: of the run.
    :return: the score.
    :raises RecordingError: where there is no result at all.
    """
    judgements, missing = [], 0
    for path in sorted((folder / 'labels').glob('case_*.json')):
        result = results / path.name
        if not result.is_file():
            missing += 1
            continue
        label = read_json(label_path(folder, path.stem))
        judgements.append(judged(path.stem, label, read_json(result)))
    if not judgements:
        raise RecordingError(
            f'{results}: holds no results of {folder}; run `tendon blind run` first'
        )
    about = read_json(folder / 'made.json')
    about['kind'] = seed_kind(about['seed'])
    return summed(judgements, about, missing)


def together(scores: Sequence[Score]) -> Score:
    """
    Put the scores of several benchmarks together.

    :param scores: of different seeds or benches.
    :return: one score of all cases.
    :raises RecordingError: where nuisances differ: such cases are not of one kind.
    """
    first = scores[0].about
    if any(s.about['nuisance'] != first['nuisance'] for s in scores):
        raise RecordingError('the nuisances of the benchmarks differ: score them apart')
    several = {
        key: ', '.join(dict.fromkeys(str(s.about[key]) for s in scores))
        for key in ('seed', 'kind', 'bench')
    }
    judgements = [j for s in scores for j in s.judgements]
    return summed(judgements, {**first, **several}, sum(s.missing for s in scores))


def summed(judgements: Sequence[Judgement], about: dict[str, Any], missing: int = 0) -> Score:
    """
    Sum up judged cases.

    :param judgements: one a case.
    :param about: what the benchmark was made of.
    :param missing: cases without a result.
    :return: the score.
    """
    rows = []
    for stratum in STRATA:
        group = [j for j in judgements if j.stratum == stratum]
        for channels in (EVERY, *CHANNEL_SETS):
            some = [j for j in group if channels in {EVERY, j.channels}]
            if some:
                rows.append(_row(stratum, channels, some))
    bins = reliability([chance for j in judgements for chance in j.chances])
    confusion = Counter(pair for j in judgements for pair in j.pairs)
    return Score(
        about=about,
        rows=tuple(rows),
        bins=bins,
        calibration_error=calibration_error(bins),
        confusion=tuple((a, b, n) for (a, b), n in sorted(confusion.items())),
        idle=tuple(value for j in judgements for value in j.idle),
        judgements=tuple(judgements),
        missing=missing,
    )


def _row(stratum: str, channels: str, some: Sequence[Judgement]) -> Row:
    foreign = some if stratum in FOREIGN else ()
    known = some if stratum in KNOWN else ()
    return Row(
        stratum=stratum,
        channels=channels,
        cases=len(some),
        verdict=_share([j.verdict_right for j in some]),
        right=_share([j.right for j in some]),
        uncertain=_share([j.uncertain for j in known]),
        found=Fraction(sum(j.found for j in known), sum(j.truths for j in known)),
        true=Fraction(sum(j.named - j.wrong for j in some), sum(j.named for j in some)),
        alarmed=_share([j.wrong > 0 for j in some]),
        place=_share([j.place_right for j in foreign]),
        place_near=_share([j.place_near for j in foreign]),
        set_size=_mean([size for j in known for size in j.sizes]),
        left=_median([j.left for j in known if not math.isnan(j.left)]),
        inside=_share([held for j in known for held in j.inside]),
        error=_median([error for j in known for error in j.errors]),
        seconds=_median([j.seconds for j in some]),
    )


def _share(true: Sequence[bool]) -> Fraction:
    return Fraction(sum(true), len(true))


def _median(values: Sequence[float]) -> float:
    return statistics.median(values) if values else math.nan


def _mean(values: Sequence[float]) -> float:
    return statistics.fmean(values) if values else math.nan
