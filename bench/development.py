"""Blind cases that may be looked at: of development seeds, the odd ones on the other bench."""

from __future__ import annotations

import argparse

from tendon_ros.blind.case import Case, made, Settings
from tendon_ros.blind.store import PUBLISHED


def development_seed(text: str) -> int:
    """Return a development seed that a user gave; for ``argparse``."""
    number = int(text)
    if not 0 <= number < PUBLISHED:
        raise argparse.ArgumentTypeError(
            f'{number}: give seeds from 0 to {PUBLISHED - 1}; those above are for publishing'
        )
    return number


def development(seed: int, index: int, strata: tuple[str, ...]) -> Case:
    """Return a case, of the strata in turn."""
    return made(seed, index, Settings(bench='other' if seed % 2 else 'bench', strata=strata))
