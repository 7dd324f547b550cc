"""
The memory of a diagnosis: the steps it has taken, so that an interrupted one goes on.

Plain JSON beside the results. What was remembered for other recordings, another file or another
version is not used.
"""

from __future__ import annotations

from collections.abc import Sequence
import contextlib
import hashlib
import json
from pathlib import Path
from typing import Any

import numpy as np

from tendon_ros import __version__
from tendon_ros.base.recording import Recording
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.explanation import Model
from tendon_ros.identify.magnitude import Magnitude
from tendon_ros.model.instrument import Instrument
from tendon_ros.model.instrument_text import text_of


class Memory:
    """
    Remembers the fitted models of a search.

    :param path: the file.
    :param recordings: what is diagnosed.
    :param instrument: its file.
    :param withhold: effects to do without.
    """

    def __init__(
        self,
        path: Path,
        recordings: Sequence[Recording],
        instrument: Instrument,
        withhold: Sequence[str] = (),
    ) -> None:
        self._path = path
        digest = hashlib.sha256(f'{__version__} {sorted(withhold)}'.encode())
        digest.update(text_of(instrument).encode())
        for recording in recordings:
            for name, channel in sorted(recording.channels.items()):
                digest.update(name.encode())
                digest.update(channel.time.tobytes())
                digest.update(channel.value.tobytes())
        self._key = digest.hexdigest()

    def models(self) -> list[Model]:
        """Return the models of the steps that were finished; none where nothing fits."""
        try:
            data = json.loads(self._path.read_text(encoding='utf-8'))
            if data['key'] != self._key:
                return []
            return [
                Model(
                    tuple(_candidate(*c) for c in row['causes']),
                    tuple(tuple(z) for z in row['z']),
                    {(place, name): float(z) for place, name, z in row['bristle']},
                    np.array(row['moved'], dtype=np.float64),
                )
                for row in data['models']
            ]
        except (OSError, ValueError, KeyError, TypeError):
            return []

    def keep(self, models: Sequence[Model]) -> None:
        """
        Remember the steps finished so far.

        :param models: one a step.
        """
        rows = [
            {
                'causes': [[c.effect, c.place, c.only, c.given, c.magnitude] for c in m.causes],
                'z': [list(row) for row in m.z],
                'bristle': [[*key, z] for key, z in m.bristle.items()],
                'moved': m.moved.tolist(),
            }
            for m in models
        ]
        text = json.dumps({'key': self._key, 'models': rows})
        part = self._path.with_suffix('.part')
        part.write_text(text, encoding='utf-8')
        part.replace(self._path)

    def forget(self) -> None:
        """Drop what was remembered: the diagnosis is done."""
        with contextlib.suppress(OSError):
            self._path.unlink()


def _candidate(
    effect: str, place: str, only: str, given: Sequence[Sequence[Any]], magnitude: Sequence[float]
) -> Candidate:
    known = tuple((str(n), float(v)) for n, v in given)
    return Candidate(effect, place, only, known, Magnitude(*map(float, magnitude)))
