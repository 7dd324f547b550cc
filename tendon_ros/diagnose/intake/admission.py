"""
Admission of recordings: one check after the other, each on what the one before has left.

Only what is surely a fault of the recording is left out. A model that is wrong by a factor of two,
friction as large as the torque, a sensor without sign, an offset, a slip or a delay is what the
diagnosis is there to find; none of it may be taken for bad input.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from tendon_ros.base.errors import RecordingError
from tendon_ros.base.recording import Recording
from tendon_ros.diagnose.intake.astray import without_astray
from tendon_ros.diagnose.intake.clipping import unclipped
from tendon_ros.diagnose.intake.clock import cut_at_breaks
from tendon_ros.diagnose.intake.counts import as_counted
from tendon_ros.diagnose.intake.fitting import fitting
from tendon_ros.diagnose.intake.limits import within_limits
from tendon_ros.diagnose.intake.motion import moving
from tendon_ros.diagnose.intake.plausible import plausible
from tendon_ros.diagnose.intake.readings import as_read
from tendon_ros.diagnose.intake.setpoints import followed
from tendon_ros.diagnose.intake.sorting import distinct, of_one_rig
from tendon_ros.diagnose.intake.stamps import as_sampled
from tendon_ros.diagnose.intake.step import Sifted
from tendon_ros.model.instrument import Instrument

_STEPS: tuple[Callable[[Sequence[Recording], Instrument], Sifted], ...] = (
    distinct,
    of_one_rig,
    fitting,
    without_astray,
    cut_at_breaks,
    moving,
    within_limits,
    followed,
    plausible,
    unclipped,
    fitting,
    as_sampled,
    without_astray,  # of stamps that scatter, only now does it show
)


@dataclass(frozen=True)
class Intake:
    """
    What a diagnosis works on.

    ``recordings`` have unique names, every motor's position, and something to compare; their
    channels keep their own stamps, unless those scatter where the motion does not, and lack the
    samples that cannot be compared. ``instrument`` has encoders that count and scatter as they do
    in these. ``left_out`` holds one sentence for each thing that was left out or taken otherwise,
    with its mend.
    """

    recordings: tuple[Recording, ...]
    instrument: Instrument
    left_out: tuple[str, ...]


def admitted(recordings: Sequence[Recording], instrument: Instrument) -> Intake:
    """
    Return recordings without what is surely faulty in them.

    :param recordings: as read or imported; they are not changed.
    :param instrument: what they are said to be of.
    :return: what is left, the instrument as it shows there, and sentences on what is not.
    :raises RecordingError: where no diagnosis is possible: one line with place, fault and mend.
    """
    if not recordings:
        raise RecordingError(f'{instrument.name}: no recording to diagnose; give at least one bag')
    present = tuple(recordings)
    left_out = [f'{r.name}: {warning}' for r in present for warning in r.warnings]
    for step in _STEPS:
        before = len(present)
        present, sentences = step(present, instrument)
        if not present:
            raise RecordingError(_as_error(sentences, before, left_out))
        left_out += sentences
    for restated in (as_counted, as_read):
        instrument, said = restated(present, instrument)
        left_out += said
    return Intake(present, instrument, tuple(dict.fromkeys(left_out)))


def _as_error(sentences: Sequence[str], recordings: int, left_out: Sequence[str]) -> str:
    """Return the line that says why nothing is left, with what had gone of the same recording."""
    said = sentences[-1] if recordings == 1 else sentences[0]
    place = said.partition(': ')[0]
    gone = [text for text in left_out if text.startswith(f'{place}: ')]
    if gone:
        said = f'{"; ".join(gone)}; then: {said}'
    return said if recordings == 1 else f'{said} (none of the {recordings} recordings can be used)'
