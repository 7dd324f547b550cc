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

    ``refused``: why nothing more could be written, empty where all was. A diagnosis goes on
    without its memory.
    """

    def __init__(
        self,
        path: Path,
        recordings: Sequence[Recording],
        instrument: Instrument,
        withhold: Sequence[str] = (),
    ) -> None:
        self._path = path
        self.refused = ''
        digest = hashlib.sha256(f'{__version__} {sorted(withhold)}'.encode())
        digest.update(text_of(instrument).encode())
        for recording in recordings:
            # what happened in one recording only is remembered by its name
            digest.update(recording.name.encode())
            for name, channel in sorted(recording.channels.items()):
                digest.update(name.encode())
                digest.update(channel.time.tobytes())
                digest.update(channel.value.tobytes())
        self._key = digest.hexdigest()
        self._models, self._weighed = self._read()

    def models(self) -> list[Model]:
        """Return the models of the steps that were finished; none where nothing fits."""
        return self._models

    def weighed(self) -> Model | None:
        """Return by what is left of which model channels weigh; None where by their noise."""
        return self._weighed

    def keep(self, models: Sequence[Model]) -> None:
        """
        Remember the steps finished so far.

        :param models: one a step.
        """
        self._models = list(models)
        self._write()

    def weigh(self, model: Model) -> None:
        """
        Remember that channels weigh by what a model leaves of them; steps before do not count.

        :param model: which.
        """
        self._models, self._weighed = [], model
        self._write()

    def _read(self) -> tuple[list[Model], Model | None]:
        try:
            data = json.loads(self._path.read_text(encoding='utf-8'))
            if data['key'] != self._key:
                return [], None
            weighed = data['weighed']
            return [_model(row) for row in data['models']], weighed and _model(weighed)
        except (OSError, ValueError, KeyError, TypeError):
            return [], None

    def _write(self) -> None:
        content = {
            'key': self._key,
            'models': [_row(m) for m in self._models],
            'weighed': None if self._weighed is None else _row(self._weighed),
        }
        text = json.dumps(content)
        part = self._path.with_suffix('.part')
        try:
            part.write_text(text, encoding='utf-8')
            part.replace(self._path)
        except OSError as error:
            self.refused = str(error.strerror)

    def forget(self) -> None:
        """Drop what was remembered: the diagnosis is done."""
        self._models, self._weighed = [], None
        with contextlib.suppress(OSError):
            self._path.unlink()


def _row(model: Model) -> dict[str, Any]:
    return {
        'causes': [
            [c.effect, c.place, c.only, c.given, c.magnitude, c.stated, c.least, c.opened]
            for c in model.causes
        ],
        'z': [list(row) for row in model.z],
        'bristle': [[*key, z] for key, z in model.bristle.items()],
        'moved': model.moved.tolist(),
        'rubs': list(model.rubs),
    }


def _model(row: dict[str, Any]) -> Model:
    return Model(
        tuple(_candidate(*c) for c in row['causes']),
        tuple(tuple(z) for z in row['z']),
        {(place, name): float(z) for place, name, z in row['bristle']},
        np.array(row['moved'], dtype=np.float64),
        tuple(row['rubs']),
    )


def _candidate(
    effect: str,
    place: str,
    only: str,
    given: Sequence[Sequence[Any]],
    magnitude: Sequence[float],
    stated: bool,
    least: float,
    opened: Sequence[str],
) -> Candidate:
    known = tuple((str(n), float(v)) for n, v in given)
    large = Magnitude(*map(float, magnitude))
    return Candidate(effect, place, only, known, large, stated, float(least), tuple(opened))
