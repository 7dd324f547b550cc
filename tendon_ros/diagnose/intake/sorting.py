"""Which recordings belong together: none twice, none of another rig, each with its own name."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from tendon_ros.base.errors import InstrumentError, RecordingError
from tendon_ros.base.recording import Recording
from tendon_ros.diagnose.intake.step import Sifted
from tendon_ros.model.instrument import Instrument
from tendon_ros.model.yaml_text import mapping_of

#: what may differ between recordings of one rig: what it touches, how it is controlled, its name
_MAY_DIFFER = frozenset({'name', 'description', 'contacts', 'load_cell', 'control', 'controller'})


def distinct(recordings: Sequence[Recording], instrument: Instrument) -> Sifted:
    """
    Leave out what was given twice, and give each recording a name of its own.

    :param recordings: what was measured.
    :param instrument: not needed.
    :return: recordings with unique names, and sentences.
    """
    kept: list[Recording] = []
    sentences: list[str] = []
    for recording in recordings:
        twin = next((k for k in kept if _same(k, recording)), None)
        if twin is not None:
            sentences.append(
                f'{recording.name}: holds the same samples as {twin.name}; counted once'
            )
            continue
        taken = {k.name for k in kept}
        number, name = 1, recording.name
        while name in taken:
            number += 1
            name = f'{recording.name} ({number})'
        kept.append(replace(recording, name=name))
    return tuple(kept), sentences


def _same(one: Recording, other: Recording) -> bool:
    """Say whether every channel that both have holds the same values."""
    names = [
        n for n in one.channels if n in other and not n.startswith(('setpoint/', 'estimate/'))
    ]
    return any(one[n].value.size > 1 for n in names) and all(
        np.array_equal(one[n].value, other[n].value) for n in names
    )


def of_one_rig(recordings: Sequence[Recording], instrument: Instrument) -> Sifted:
    """
    Refuse recordings that tell of different rigs.

    :param recordings: with what their bags say of the rig, where they do.
    :param instrument: not needed; a file may differ from the rig.
    :return: the recordings as they are.
    :raises RecordingError: where two recordings name different rigs.
    """
    first: dict[str, tuple[Recording, Any]] = {}
    for recording in recordings:
        for key, said in _said(recording).items():
            before, other = first.setdefault(key, (recording, said))
            difference = _difference(other, said, '')
            if difference:
                field, a, b = difference
                raise RecordingError(
                    f'{recording.name}: metadata {key}: recorded on another rig than '
                    f'{before.name} ({field or key}: {b} against {a}); diagnose the recordings '
                    'of each rig by themselves'
                )
    return tuple(recordings), []


def _said(recording: Recording) -> Mapping[str, Any]:
    """Return what a recording says of its rig."""
    said: dict[str, Any] = {}
    if 'rig' in recording.metadata:
        said['rig'] = recording.metadata['rig']
    if 'instrument_yaml' in recording.metadata:
        try:
            text = recording.metadata['instrument_yaml']
            said['instrument_yaml'] = mapping_of(text, Path(recording.name))
        except InstrumentError:
            return said  # a note that cannot be read says nothing
    return said


def _difference(one: Any, other: Any, field: str) -> tuple[str, object, object] | None:
    """Return the first field in which two descriptions differ, with both values."""
    if isinstance(one, dict) and isinstance(other, dict):
        for key in (*one, *(k for k in other if k not in one)):
            if key in _MAY_DIFFER:
                continue
            below = f'{field}.{key}' if field else str(key)
            found = _difference(one.get(key, 'nothing'), other.get(key, 'nothing'), below)
            if found:
                return found
        return None
    return None if one == other else (field, one, other)
