"""Laws: slopes are the slopes, neutral means nothing, friction never gives power."""

import itertools
import math

from hypothesis import given, strategies
import numpy as np
import pytest

from tendon_ros.effects import catalogue

LAWS = [e for e in catalogue().values() if e.law]

#: argument: range of states that instruments reach, step of the finite difference
DOMAIN = {
    'theta': (-3.0, 3.0, 1e-6),
    'omega': (-20.0, 20.0, 1e-6),
    'speed': (0.01, 20.0, 1e-6),
    'load': (0.0, 20.0, 1e-5),
    'delta': (-3e-3, 3e-3, 1e-8),
    'rate': (-0.5, 0.5, 1e-7),
    'z': (-1.0, 1.0, 1e-6),
    't': (0.0, 20.0, None),
    'side': (-1.0, 1.0, None),
}
ARGUMENTS = {
    'torque': ('theta', 'omega', 't'),
    'budget': ('speed', 'side', 'load'),
    'elongation': ('delta', 't'),
    'relaxation': ('delta', 'z'),
    'tension': ('delta', 'rate', 'z', 't'),
    'winding': ('theta',),
}
#: hook: number of results, then for each result that has slopes: where each slope stands
SLOPES = {
    'torque': (3, {0: {'theta': 1, 'omega': 2}}),
    'budget': (3, {0: {'speed': 1, 'load': 2}}),
    'elongation': (2, {0: {'delta': 1}}),
    'relaxation': (7, {0: {'delta': None, 'z': 1}, 4: {'delta': 5, 'z': 6}}),
    'tension': (
        8,
        {0: {'delta': 1, 'rate': 2, 'z': 3}, 4: {'delta': 5, 'rate': 6, 'z': 7}},
    ),
    'winding': (3, {0: {'theta': 1}, 1: {'theta': 2}}),
}
#: the results that act on the mechanics: the value and its slopes, or the part that relaxes
ACTING = {
    'torque': slice(3),
    'budget': slice(3),
    'elongation': slice(2),
    'relaxation': slice(2, 3),
    'tension': slice(4),
    'winding': slice(3),
}

over_laws = pytest.mark.parametrize('effect', LAWS, ids=lambda e: e.id)
over_budgets = pytest.mark.parametrize(
    'effect', [e for e in LAWS if e.hook == 'budget'], ids=lambda e: e.id
)


def states(hook, rng, count):
    """Yield states of a hook's arguments, away from the corners at rate zero."""
    for _ in range(count):
        state = {name: rng.uniform(*DOMAIN[name][:2]) for name in ARGUMENTS[hook]}
        if 'side' in state:
            state['side'] = math.copysign(1.0, state['side'])
        if abs(state.get('rate', 1.0)) < 1e-3:
            state['rate'] = 1e-3
        yield state


def parameters(effect, rng):
    """Return parameters of the size worth looking for, up to four times more or less."""
    values = []
    for p in effect.parameters:
        size = p.typical * 4.0 ** rng.uniform(-1.0, 1.0) or rng.uniform(p.low, p.high)
        sign = rng.choice([-1.0, 1.0]) if p.low < 0.0 else 1.0
        values.append(float(np.clip(sign * size, p.low, p.high)))
    return values


def law_at(effect, state, values):
    """Call the law of an effect."""
    return effect.law(*(state[name] for name in ARGUMENTS[effect.hook]), *values)


@over_laws
def test_results_are_floats(effect):
    """One integer among them would be another type to the compiler."""
    rng = np.random.default_rng(1)
    for state in states(effect.hook, rng, 20):
        state = {name: float(value) for name, value in state.items()}
        results = law_at(effect, state, parameters(effect, rng))
        assert [type(value) for value in results] == [float] * SLOPES[effect.hook][0]


@over_laws
def test_slopes_against_finite_differences(effect):
    rng = np.random.default_rng(2)
    for state in states(effect.hook, rng, 60):
        values = parameters(effect, rng)
        here = law_at(effect, state, values)
        for result, slopes in SLOPES[effect.hook][1].items():
            for name, place in slopes.items():
                step = DOMAIN[name][2]
                ahead = law_at(effect, state | {name: state[name] + step}, values)[result]
                behind = law_at(effect, state | {name: state[name] - step}, values)[result]
                slope = 0.0 if place is None else here[place]
                rounding = 1e-14 * max(abs(ahead), abs(behind)) / step
                difference = (ahead - behind) / (2.0 * step)
                assert slope == pytest.approx(difference, rel=1e-5, abs=1e-7 + rounding), (
                    f'result {result} by {name} at {state} with {values}'
                )


@over_laws
def test_neutral_changes_nothing(effect):
    values = list(effect.neutral.values())
    for state in states(effect.hook, np.random.default_rng(3), 100):
        assert not any(law_at(effect, state, values)[ACTING[effect.hook]])


@over_laws
def test_typical_changes_something(effect):
    values = list(effect.typical.values())
    times = [0.0, 5.1]  # some act at a time only
    found = [
        law_at(effect, state | {'t': t}, values)[ACTING[effect.hook]]
        for state in states(effect.hook, np.random.default_rng(4), 20)
        for t in times
    ]
    assert np.any(found)


@over_laws
def test_time_enters_through_switches_only(effect):
    if 't' not in ARGUMENTS[effect.hook]:
        assert effect.switches is None
        return
    rng = np.random.default_rng(5)
    values = parameters(effect, rng)
    [state] = states(effect.hook, rng, 1)
    times = effect.switches(*values) if effect.switches else ()
    edges = [0.0, *times, max(times, default=0.0) + 10.0]
    for before, after in itertools.pairwise(edges):
        inside = np.linspace(before, after, 7)[1:-1]
        assert len({law_at(effect, state | {'t': t}, values) for t in inside}) == 1
    for time in times:
        assert law_at(effect, state | {'t': time - 1e-9}, values) != law_at(
            effect, state | {'t': time + 1e-9}, values
        )


@over_budgets
@given(data=strategies.data())
def test_dry_friction_is_never_negative(effect, data):
    """The kernel turns a budget against the motion: power is taken as long as it is positive."""
    values = [data.draw(strategies.floats(p.low, p.high), label=p.name) for p in effect.parameters]
    speed = data.draw(strategies.floats(0.0, 1e3), label='speed')
    side = data.draw(strategies.sampled_from([-1.0, 1.0]), label='side')
    load = data.draw(strategies.floats(0.0, 1e3), label='load')
    limit, by_speed, by_load = effect.law(speed, side, load, *values)
    assert limit >= 0.0
    assert math.isfinite(limit + by_speed + by_load)
    assert effect.dissipative


def hardening(x):
    """Return the net force [N] of a loop whose tension grows faster than its elongation [m]."""
    return 1e4 * x + 1e10 * x**3


def cycle_energy(effect, values, period, amplitude, cycles):
    """Return the work [J] that a hardening loop takes over the last of some cycles."""
    steps = 4000
    h = period / steps
    z = work = 0.0
    for n in range(cycles * steps):
        if n == (cycles - 1) * steps:
            work = 0.0
        # two harmonics: a reversal within the cycle, too
        phase = 2.0 * math.pi * (n + 0.5) / steps
        delta = amplitude * (math.sin(phase) + 0.5 * math.sin(3.0 * phase))
        rate = amplitude * 2.0 * math.pi / period * (math.cos(phase) + 1.5 * math.cos(3.0 * phase))
        if effect.hook == 'tension':
            force, _, _, _, z_rate, _, _, slope = effect.law(delta, rate, z, 0.0, *values)
        else:
            settled, _, part, share, z_rate, _, slope = effect.law(delta, z, *values)
            force = share * (hardening(delta) - part * hardening(settled))
            force += (1.0 - share) * hardening(delta - part * settled)
        work += force * rate * h
        z += h * z_rate / (1.0 - h * slope)  # implicit Euler in z, for any stiffness
    return work


@pytest.mark.parametrize(
    'effect', [e for e in LAWS if e.dissipative and e.hook != 'budget'], ids=lambda e: e.id
)
@pytest.mark.parametrize('period', [0.3, 3.0, 30.0])
@pytest.mark.parametrize('amplitude', [5e-5, 1e-3])
@pytest.mark.parametrize('end', ['low', 'typical', 'high'])
def test_a_closed_cycle_takes_energy(effect, period, amplitude, end):
    assert effect.hook in ('tension', 'relaxation')
    shares = {p.name: getattr(p, end) for p in effect.parameters if p.name == 'share'}
    values = list({**effect.typical, **shares}.values())
    # long enough for the state to close its cycle too
    cycles = 3 + int(15.0 / period)
    taken = cycle_energy(effect, values, period, amplitude, cycles)
    neutral = cycle_energy(effect, list(effect.neutral.values()), period, amplitude, 1)
    assert neutral == pytest.approx(0.0, abs=1e-9)
    assert taken > 1e-9


def test_hysteresis_closes_the_loop_that_it_says():
    """Over +-a, a cycle takes 4 * force * (a - elongation): the loop less its corners."""
    law = catalogue()['cable_hysteresis'].law
    amplitude, force, elongation = 1e-3, 2.0, 1e-5
    half = 20000  # steps
    z = work = 0.0
    for stroke in range(4):
        step = 2.0 * amplitude / half * (-1.0) ** stroke
        for _ in range(half):
            pull, _, _, _, z_step, _, _, _ = law(0.0, step, z, 0.0, force, elongation)
            z += z_step
            work += pull * step if stroke >= 2 else 0.0
        assert z == pytest.approx((-1.0) ** stroke, abs=1e-6)
    assert work == pytest.approx(4.0 * force * (amplitude - elongation), rel=1e-3)


def test_creep_is_a_standard_linear_solid():
    """What has settled of a held loop grows to delta, exponentially."""
    law = catalogue()['cable_creep'].law
    fraction, time, share, delta = 0.3, 2.0, 0.4, 1e-3
    z, h = 0.0, 1e-3
    for n in range(20001):
        settled, _, *how, z_rate, _, _ = law(delta, z, fraction, time, share)
        assert how == [fraction, share]
        assert settled == pytest.approx(delta * (1.0 - math.exp(-n * h / time)), abs=2e-4 * delta)
        z += h * z_rate
    assert z == pytest.approx(1.0, abs=1e-3)


def test_stribeck_falls_to_the_sliding_friction():
    law = catalogue()['stribeck_friction'].law
    assert law(0.0, 1.0, 0.0, 0.1, 0.04, 0.2)[0] == pytest.approx(0.14)
    assert law(0.2, 1.0, 0.0, 0.1, 0.04, 0.2)[0] == pytest.approx(0.09)
    assert law(200.0, 1.0, 0.0, 0.1, 0.04, 0.2)[0] == pytest.approx(0.04, rel=1e-4)


def test_asymmetric_friction_tells_directions_apart():
    law = catalogue()['asymmetric_friction'].law
    assert law(0.5, 1.0, 0.0, 0.08, 0.03)[0] == 0.08
    assert law(0.5, -1.0, 0.0, 0.08, 0.03)[0] == 0.03


def test_asymmetric_friction_is_two_effects_at_once():
    forward, backward = 0.3, 0.1
    both = catalogue()['asymmetric_friction'].alike(forward, backward)
    law = catalogue()['asymmetric_friction'].law
    limits = [law(0.1, side, 0.0, forward, backward)[0] for side in (1.0, -1.0)]
    # what rubs more forward is pushed backward by the rest of it
    assert limits == pytest.approx(
        [both['coulomb_friction'] + way * both['torque_bias'] for way in (1.0, -1.0)]
    )


def test_weight_hangs_where_it_says():
    law = catalogue()['gravity'].law
    torque, by_theta, _ = law(0.4, 0.0, 0.0, 0.1, 0.4)
    assert torque == 0.0
    assert by_theta == pytest.approx(-0.1)
    assert law(0.4 + math.pi / 2, 0.0, 0.0, 0.1, 0.4)[0] == pytest.approx(-0.1)


def test_joint_spring_pulls_to_its_rest():
    law = catalogue()['joint_spring'].law
    assert law(0.5, 3.0, 0.0, 2.0, 0.2)[0] == pytest.approx(-0.6)


def test_ripple_repeats_within_the_turn():
    law = catalogue()['torque_ripple'].law
    values = (0.02, 12.0, 0.3)
    crest = (0.3 + math.pi / 2) / 12.0
    assert law(crest, 0.0, 0.0, *values)[0] == pytest.approx(0.02)
    assert law(crest + 2.0 * math.pi / 12.0, 0.0, 0.0, *values)[0] == pytest.approx(0.02)
    assert law(crest + math.pi / 12.0, 0.0, 0.0, *values)[0] == pytest.approx(-0.02)


def test_eccentric_pulley_winds_its_mean_radius_over_a_turn():
    law = catalogue()['eccentricity'].law
    assert law(0.0, 0.02, 0.7)[0] == pytest.approx(0.0)
    assert law(2.0 * math.pi, 0.02, 0.7)[0] == pytest.approx(0.0)
    assert law(0.7, 0.02, 0.7)[1] == pytest.approx(0.02)  # the largest radius


def test_slip_lasts_and_disturbance_passes():
    slip = catalogue()['cable_slip'].law
    assert [slip(0.0, t, 2e-4, 7.0)[0] for t in (6.9, 7.0, 99.0)] == [0.0, 2e-4, 2e-4]
    push = catalogue()['disturbance'].law
    assert [push(0.0, 0.0, t, 0.2, 5.0, 0.5)[0] for t in (4.9, 5.0, 5.4, 5.6)] == [
        0.0,
        0.2,
        0.2,
        0.0,
    ]
