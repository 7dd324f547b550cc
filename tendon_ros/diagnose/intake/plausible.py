"""
Channels of the wrong sign or unit, and dead ones: by what the model expects under the same motion.

Stamps of channels that another recorder took are moved before that, for a shape that is moved says
nothing of signs. Only clear cases count: a correlation of the wrong sign that no rectified sensor
and no unmodelled spring or weight can make, a factor that is exactly that of a unit, or not a
single change where the model expects a large one.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from tendon_ros.base.recording import Recording
from tendon_ros.diagnose.intake.expected import Expectation, expectations
from tendon_ros.diagnose.intake.judgement import Finding, judged, UNTOLD
from tendon_ros.diagnose.intake.misdriven import misdriven, suspicious
from tendon_ros.diagnose.intake.step import Sifted, without
from tendon_ros.diagnose.intake.unsynchronised import on_one_clock
from tendon_ros.identify.driving import encoder_channels
from tendon_ros.model.instrument import Instrument


@dataclass(frozen=True)
class _Judged:
    """One recording with what was found in its channels; None for a channel that is sound."""

    recording: Recording
    findings: Mapping[str, Finding | None]


def plausible(recordings: Sequence[Recording], instrument: Instrument) -> Sifted:
    """
    Leave out recordings with a wrong motor position, and wrong or dead channels.

    :param recordings: with every motor's position.
    :param instrument: the network.
    :return: the rest, and sentences.
    """
    if len(encoder_channels(instrument)) < len(instrument.motors):
        # what is driven by torque drifts: no shape can be held against it
        return tuple(recordings), []
    runs = [expectations(recording, instrument) for recording in recordings]
    faults = [misdriven(r, instrument, own) for r, own in zip(recordings, runs, strict=True)]
    common = next((fault for fault in faults if fault), '')
    heard: list[_Judged] = []
    sentences: list[str] = []
    for recording, own, fault in zip(recordings, runs, faults, strict=True):
        # what is wrong in one recording is believed sooner of the others
        said = fault or (common if suspicious(own) else '')
        if said:
            sentences.append(f'{recording.name}: {said}')
            continue
        moved, late = on_one_clock(recording, own)
        sentences += late
        heard.append(_Judged(moved, _findings(expectations(moved, instrument) if late else own)))
    spreading = _spreading(heard)
    kept = []
    for one in heard:
        found = {**spreading, **one.findings}
        wrong = {n: f for n, f in found.items() if f and n in one.recording}
        kept.append(without(one.recording, wrong))
        sentences += [
            f'{one.recording.name}: {name} left out: {finding.words}'
            for name, finding in wrong.items()
        ]
    return tuple(kept), sentences


def _findings(runs: Sequence[Expectation]) -> dict[str, Finding | None]:
    """Return what is found in each channel of which the model tells anything."""
    if not runs:
        return {}
    names = dict.fromkeys(name for run in runs for name in run.comparisons)
    told = {name: judged(name, runs) for name in names}
    return {name: finding for name, finding in told.items() if finding is not UNTOLD}


def _spreading(recordings: Sequence[_Judged]) -> dict[str, Finding | None]:
    """Return what also holds where nothing is told: a fault in every recording that tells."""
    found: dict[str, Finding | None] = {}
    for name in dict.fromkeys(n for one in recordings for n in one.findings):
        said = [one.findings[name] for one in recordings if name in one.findings]
        if all(finding and finding.spreads for finding in said):
            found[name] = said[0]
    return found
