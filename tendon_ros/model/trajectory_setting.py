"""Settings of a named trajectory: unit, meaning and bounds, beside its default."""

from __future__ import annotations

from dataclasses import dataclass
import math


@dataclass(frozen=True)
class Setting:
    """One setting: SI ``unit`` (empty for names and counts), ``meaning``, bounds of a number."""

    unit: str
    meaning: str
    low: float = -math.inf
    high: float = math.inf
