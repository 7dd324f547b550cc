"""Made-up diagnoses with made-up evidence: nothing here was measured or diagnosed."""

from collections.abc import Callable
from functools import cache

import numpy as np
import pytest

from tendon_ros.diagnose.evidence import Evidence, Floor, Moved, Rival, Step, Told, Trace
from tendon_ros.diagnose.result import (
    Candidate,
    Cause,
    ChannelGap,
    Diagnosis,
    FittedParameter,
    Judged,
    NextExperiment,
    Shrink,
    Unexplained,
    Where,
)
from tendon_ros.report.diagnosis_page import diagnosis_page

type Case = tuple[Diagnosis, Evidence]

FLOORS = {
    'actuator/pulley_M/effort': ('N m', 0.0083),
    'actuator/pulley_L/effort': ('N m', 0.0079),
    'load_cell/force': ('N', 0.052),
    'pulley/pulley_3/position': ('rad', 0.00012),
}
CHANNELS = tuple(FLOORS)
RECORDINGS = ('contact', 'free', 'mixed')


def gap(channel: str, before: float, after: float) -> ChannelGap:
    """Return a channel's gap from numbers in noise floors."""
    unit, floor = FLOORS[channel]
    ci95 = (0.94 * after * floor, 1.07 * after * floor)
    return ChannelGap(
        channel=channel,
        unit=unit,
        before=before * floor,
        after=after * floor,
        noise_floor=floor,
        ci95=ci95,
    )


def shrink(before: float, without: float, after: float) -> Shrink:
    """Return what a cause is worth to the first channel, from numbers in noise floors."""
    unit, floor = FLOORS[CHANNELS[0]]
    return Shrink(
        channel=CHANNELS[0],
        unit=unit,
        before=before * floor,
        without_this=without * floor,
        after=after * floor,
    )


def friction(before: float = 6.3, without: float = 4.8, after: float = 1.1) -> Cause:
    """Return a cause that stands alone."""
    return Cause(
        effect='tension_friction',
        place='pulley_3',
        probability=0.97,
        parameters={'coefficient': FittedParameter(value=0.0523, unit='1', ci95=(0.0498, 0.0551))},
        shrink=shrink(before, without, after),
    )


def pretension(before: float = 6.3, without: float = 2.2, after: float = 1.1) -> Cause:
    """Return a cause with others that look the same."""
    return Cause(
        effect='pretension',
        place='cable_L3',
        probability=0.91,
        parameters={'scale': FittedParameter(value=0.9, unit='1', ci95=(0.884, 0.917))},
        indistinguishable=(
            Candidate(effect='pretension', place='cable_12'),
            Candidate(effect='cable_stiffness', place='cable_L3'),
        ),
        shrink=shrink(before, without, after),
    )


def stribeck(before: float = 6.3, without: float = 1.6, after: float = 1.1) -> Cause:
    """Return a cause with several parameters, one of them not bounded."""
    return Cause(
        effect='stribeck_friction',
        place='pulley_1',
        probability=0.78,
        parameters={
            'static': FittedParameter(value=0.0214, unit='N m', ci95=(0.0171, 0.0258)),
            'sliding': FittedParameter(value=0.0052, unit='N m', ci95=(0.0011, 0.0094)),
            'speed': FittedParameter(value=0.08, unit='rad/s', ci95=(0.02, np.inf)),
        },
        shrink=shrink(before, without, after),
    )


WHERE = tuple(
    Where(place=place, regime=regime, share=share)
    for place, regime, share in (
        ('pulley_3', 'reversal', 0.38),
        ('pulley_3', 'high tension', 0.21),
        ('cable_L3', 'low tension', 0.12),
        ('pulley_1', 'sticking', 0.09),
        ('cable_L3', 'contact', 0.06),
        ('pulley_3', 'sticking', 0.05),
        ('motor_M', 'reversal', 0.04),
        ('load_cell', 'contact', 0.03),
        ('pulley_2', 'reversal', 0.015),
        ('encoder_3', 'high speed', 0.005),
    )
)

HIDDEN = tuple(
    Judged(effect=effect, place=place, probability=0.0, identifiable=False, why_not=why)
    for effect, places, why in (
        ('inertia', ('pulley_M', 'pulley_L', 'pulley_1'), 'leaves no trace at these speeds'),
        ('backlash', ('motor_M', 'motor_L'), 'the torque never changes sign'),
        ('torque_saturation', ('motor_M', 'motor_L'), 'the torque stays below 2.1 N m'),
    )
    for place in places
)
SEEN = tuple(
    Judged(effect=effect, place=f'pulley_{name}', probability=probability, identifiable=True)
    for effect, probability in (
        ('presliding_friction', 0.12),
        ('coulomb_friction', 0.06),
        ('asymmetric_friction', 0.004),
        ('eccentricity', 0.0),
        ('gravity', 0.0),
    )
    for name in 'ML123'
)


def diagnosis(**changes: object) -> Diagnosis:
    """Return a diagnosis with three causes, with fields replaced."""
    causes = changes.pop('causes', (friction(), pretension(), stribeck()))
    assert isinstance(causes, tuple)
    fields: dict[str, object] = {
        'schema': 1,
        'verdict': 'explained',
        'gap': (
            gap(CHANNELS[0], 7.9, 1.12),
            gap(CHANNELS[1], 6.1, 1.08),
            gap(CHANNELS[2], 4.4, 1.15),
            gap(CHANNELS[3], 1.9, 1.02),
        ),
        'closed_loop': (
            gap(CHANNELS[0], 9.1, 1.6),
            gap(CHANNELS[2], 11.2, 1.9),
            ChannelGap(
                channel='actuator/pulley_L/position',
                unit='rad',
                before=0.00256,
                after=0.00022,
                noise_floor=0.0,
                ci95=(0.00012, 0.0003),
            ),
        ),
        'where': WHERE,
        'causes': causes,
        'candidates': (
            *(
                Judged(
                    effect=c.effect, place=c.place, probability=c.probability, identifiable=True
                )
                for c in causes
            ),
            *SEEN,
            *HIDDEN,
        ),
        'unexplained': Unexplained(probability=0.03),
        'next_experiment': (
            NextExperiment(
                separates=(('pretension', 'cable_L3'), ('pretension', 'cable_12')),
                do='move motor L freely through ±20° at 0.1 to 0.6 Hz for 24 s, motor M held',
                add_channel='pulley/pulley_1/position',
            ),
            NextExperiment(
                separates=(('inertia', 'pulley_1'),),
                do='sweep motor M from 2 to 12 Hz at 2° for 18 s',
            ),
        ),
        'left_out': ('free: 0.4 s from 7.31 s, the stamps jump by 0.12 s',),
    }
    return Diagnosis.model_validate(fields | changes)


def trace(recording: str, channel: str, seed: int, strength: float, seconds: float) -> Trace:
    """Return a trace whose gap is friction's: it changes sign with the motion."""
    unit, floor = FLOORS[channel]
    random = np.random.default_rng(seed)
    time = np.arange(0.0, seconds, 0.002)
    phase = 2.0 * np.pi * 0.23 * time + 0.6 * seed
    amplitude = 40.0 * floor
    model = amplitude * (np.sin(phase) + 0.25 * np.sin(2.7 * phase))
    lost = strength * floor * np.tanh(4.0 * np.cos(phase)) * (1.0 + 0.4 * np.sin(phase))
    noise = floor * random.standard_normal(time.size)
    held_out = (time % 8.0) > 5.0
    return Trace(
        recording, channel, unit, time, model + lost + noise, model, model + 0.97 * lost, held_out
    )


def traces(*recordings: str) -> tuple[Trace, ...]:
    """Return a trace of each channel and recording."""
    strengths = (7.9, 6.0, 4.2, 1.6)
    return tuple(
        trace(recording, channel, 3 * k + n, strength * (1.0 - 0.2 * n), 16.0)
        for n, recording in enumerate(recordings)
        for k, (channel, strength) in enumerate(zip(CHANNELS, strengths, strict=True))
    )


def evidence(*recordings: str, **changes: object) -> Evidence:
    """Return what goes with :func:`diagnosis`, of some recordings, with fields replaced."""
    fields: dict[str, object] = {
        'instrument': 'bench_rig',
        'recordings': recordings,
        'traces': traces(*recordings),
        'closed_loop': (trace('contact', CHANNELS[2], 5, 11.0, 16.0),),
        'steps': (
            Step('', '', 6.1, 6.3),
            Step('tension_friction', 'pulley_3', 2.4, 2.6),
            Step('pretension, stribeck_friction', 'cable_L3, pulley_1', 1.08, 1.12),
            Step('', '', 1.05, 1.1),
        ),
        'floors': tuple(
            Floor(channel, unit, value, 'repeated cycles: spread between 6 of them')
            for channel, (unit, value) in FLOORS.items()
        ),
        'moved': (
            Moved('pulley_3', 'inertia', 1.021, (0.987, 1.055), '1'),
            Moved('cable_12', 'pretension', 0.994, (0.981, 1.007), '1'),
            Moved('encoder_M', 'angle', -0.00021, (-0.00034, -0.00008), 'rad'),
        ),
        'told': (
            Told(
                'contact',
                'tension_friction',
                'pulley_3',
                'coefficient',
                '1',
                0.096,
                (0.083, 0.109),
                '',
            ),
            Told(
                'free',
                'tension_friction',
                'pulley_3',
                'coefficient',
                '1',
                0.02,
                (-0.1, 0.14),
                'others do the same',
            ),
            Told('contact', 'pretension', 'cable_L3', 'scale', '1', 0.9, (0.8, 1.0), 'no trace'),
        ),
        'rivals': (
            Rival('tension_friction', 'pulley_3', 0.83),
            *(Rival(j.effect, j.place, 0.7 * 0.82**k) for k, j in enumerate(SEEN)),
            Rival('pretension', 'cable_L3', 0.14),
        ),
        'seconds': 41.3,
    }
    return Evidence(**(fields | changes))  # type: ignore[arg-type]


def no_gap() -> Case:
    """Return a rig that does what its file says."""
    return (
        diagnosis(
            verdict='no_gap',
            gap=tuple(gap(c, 1.03 + 0.02 * k, 1.0) for k, c in enumerate(CHANNELS)),
            closed_loop=(),
            where=(),
            causes=(),
            candidates=(*SEEN[10:], *HIDDEN),
            unexplained=Unexplained(probability=0.01),
            next_experiment=(),
            left_out=(),
        ),
        evidence('contact', steps=(Step('', '', 1.01, 1.06),), rivals=(), closed_loop=()),
    )


def one_cause() -> Case:
    """Return one effect and the motors alone, without a closed loop."""
    return (
        diagnosis(
            gap=(gap(CHANNELS[0], 6.3, 1.1),),
            closed_loop=(),
            where=WHERE[:2],
            causes=(friction(),),
            next_experiment=(),
            left_out=(),
        ),
        evidence(
            'contact',
            traces=(trace('contact', CHANNELS[0], 1, 6.3, 16.0),),
            closed_loop=(),
            steps=(Step('', '', 6.1, 6.3), Step('tension_friction', 'pulley_3', 1.05, 1.1)),
            moved=(),
        ),
    )


def partly() -> Case:
    """Return a gap that two effects explain in part."""
    return (
        diagnosis(
            verdict='partly_explained',
            gap=(gap(CHANNELS[0], 23.0, 4.1), gap(CHANNELS[2], 14.0, 2.2)),
            causes=(friction(19.0, 11.0, 3.3), stribeck(19.0, 5.2, 3.3)),
            unexplained=Unexplained(
                probability=0.88, where=('pulley_2', 'cable_12'), regime='fast motion'
            ),
        ),
        evidence('contact'),
    )


def unexplained() -> Case:
    """Return a gap without a cause, in many recordings."""
    names = tuple(f'run_{k:02d}' for k in range(24))
    return (
        diagnosis(
            verdict='unexplained',
            gap=tuple(gap(c, 9.0 - k, 8.7 - k) for k, c in enumerate(CHANNELS)),
            causes=(),
            beside=(stribeck(19.0, 9.1, 4.0).model_copy(update={'probability': 0.31}),),
            closed_loop=(),
            unexplained=Unexplained(probability=0.96, where=('pulley_3',), regime='reversal'),
        ),
        evidence(
            *names,
            traces=tuple(
                trace(name, channel, k, 4.0 + (k % 7), 6.0)
                for k, name in enumerate(names)
                for channel in CHANNELS[:2]
            ),
            closed_loop=(),
            steps=(Step('', '', 7.7, 7.8),),
        ),
    )


def three_causes() -> Case:
    """Return three effects, explained, with everything that a report can show."""
    return diagnosis(), evidence(*RECORDINGS)


CASES: dict[str, Callable[[], Case]] = {
    case.__name__: case for case in (no_gap, one_cause, three_causes, partly, unexplained)
}


@pytest.fixture(params=CASES)
def any_name(request: pytest.FixtureRequest) -> str:
    """Return the name of each made-up diagnosis."""
    return str(request.param)


@pytest.fixture(scope='session')
def case() -> Callable[[str], Case]:
    """Return made-up diagnoses by name."""
    return cache(lambda name: CASES[name]())


@pytest.fixture(scope='session')
def page(case: Callable[[str], Case]) -> Callable[[str], str]:
    """Return the pages of made-up diagnoses by name, each drawn once."""
    return cache(lambda name: diagnosis_page(*case(name)))
