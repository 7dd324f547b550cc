"""The instrument file with what was found: effects, and numbers within tolerance."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
import math

from tendon_ros.diagnose.gap import beyond_noise
from tendon_ros.diagnose.result import ChannelGap
from tendon_ros.identify.explanation import bristles, Model
from tendon_ros.identify.fit import Problem
from tendon_ros.model.cable import hardened
from tendon_ros.model.effect_use import in_force, whole
from tendon_ros.model.instrument import contact_place, Curve, Instrument


def patched(
    problem: Problem, model: Model, instrument: Instrument, recording: str = ''
) -> Instrument:
    """
    Return the instrument with the causes of a model, everything else as fitted.

    :param problem: the data.
    :param model: the fitted model.
    :param instrument: the file as it was.
    :param recording: whose events are wanted too; without it only what acts in all recordings is.
    :return: effects beside those of the file; inertias, dampings, preloads and stiffnesses moved
        within their tolerances; a loop whose stiffness moved has a curve of its own.
    """
    far = [
        (t, z)
        for t, z in problem.moved(model)
        if abs(t.axis.value(z) - t.axis.centre) > 1e-4 * t.axis.scale
    ]
    # what an effect of the file says already, that effect says anew
    moved = {(t.place, t.quantity): t.axis.value(z) for t, z in far if not t.given}
    undamped: set[str] = set()

    def damped(place: str, damping: float) -> float:
        left = max(0.0, damping + moved.get((place, 'damping'), 0.0))
        undamped.update([f'{place}.damping'] if left == 0.0 else [])
        return left

    pulleys = tuple(
        replace(
            p,
            inertia=p.inertia * moved.get((f'pulley_{p.name}', 'inertia'), 1.0),
            damping=damped(f'pulley_{p.name}', p.damping),
        )
        for p in instrument.pulleys
    )
    couplings = tuple(
        replace(
            c,
            stiffness=c.stiffness * moved.get((f'coupling_{c.name}', 'stiffness'), 1.0),
            damping=damped(f'coupling_{c.name}', c.damping),
        )
        for c in instrument.couplings
    )
    curves = {c.name: c for c in instrument.curves}
    loops = []
    for loop in instrument.loops:
        place = f'cable_{loop.name}'
        scale = moved.get((place, 'stiffness'), 1.0)
        hardening = moved.get((place, 'hardening'), 1.0)
        own = loop.curve
        if scale != 1.0 or hardening != 1.0:
            old = hardened(curves[loop.curve], hardening)
            own = f'{old.name}_{loop.name}'
            curves[own] = Curve(own, old.elongation, tuple(scale * t for t in old.tension))
        tight = loop.pretension * moved.get((place, 'pretension'), 1.0)
        curves[own] = _reaching(curves[own], tight)
        damping = damped(place, loop.damping)
        loops.append(replace(loop, curve=own, pretension=tight, damping=damping))
    contacts = []
    for c in instrument.contacts:
        place = contact_place(instrument, c)
        contacts.append(
            replace(
                c,
                stiffness=c.stiffness * moved.get((place, 'stiffness'), 1.0),
                damping=damped(place, c.damping),
                position=c.position + moved.get((place, 'position'), 0.0),
            )
        )
    # a motor's torque constant is no number of the file: it stays an effect
    known = [t.use(z) for t, z in far if t.given or t.quantity == 'torque_gain']
    accepted = [
        whole(model.use(k)) for k, cause in enumerate(model.causes) if cause.acts_in(recording)
    ]
    bent = bristles(model, instrument.effects, problem.rollouts.tolerance)
    used = {loop.curve for loop in loops}
    return replace(
        instrument,
        pulleys=pulleys,
        loops=tuple(loops),
        couplings=couplings,
        curves=tuple(c for name, c in curves.items() if name in used),
        contacts=tuple(contacts),
        effects=in_force(instrument.effects, [*known, *accepted, *bent]),
        # a share of nothing is no tolerance, and no file may state one
        tolerances={
            name: spread
            for name, spread in instrument.tolerances.items()
            if name not in undamped or math.isinf(spread)
        },
    )


def doubted(instrument: Instrument, gaps: Sequence[ChannelGap]) -> Instrument:
    """
    Return an instrument that states how far it is off: estimates rest on it.

    :param instrument: as it was fitted.
    :param gaps: of its channels, on what no fit has seen.
    :return: with what is left beyond noise as the misfit of each sensor.
    """
    left = {g.channel: beyond_noise(g.after, g.noise_floor) for g in gaps}
    sensors = tuple(
        replace(s, misfit=float(f'{left[s.channel]:.3g}')) if s.channel in left else s
        for s in instrument.sensors
    )
    return replace(instrument, sensors=sensors)


def _reaching(curve: Curve, tension: float) -> Curve:
    """Return a curve that goes on straight, if need be, until well beyond a tension."""
    if tension < curve.tension[-1]:
        return curve
    (e, f), (t, u) = curve.elongation[-2:], curve.tension[-2:]
    further = f + (2.0 * tension - u) * (f - e) / (u - t)
    return Curve(curve.name, (*curve.elongation, further), (*curve.tension, 2.0 * tension))
