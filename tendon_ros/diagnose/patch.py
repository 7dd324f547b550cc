"""The instrument file with what was found: accepted effects, and numbers within tolerance."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace

from tendon_ros.identify.fit import bristles, Model, Problem
from tendon_ros.model.instrument import contact_place, Curve, Instrument


def patched(
    problem: Problem, model: Model, instrument: Instrument, believed: Collection[int]
) -> Instrument:
    """
    Return the instrument with the effects that are believed, everything else as fitted.

    :param problem: the data.
    :param model: the fitted model.
    :param instrument: the file as it was.
    :param believed: which causes of the model are accepted.
    :return: effects beside those of the file; inertias, dampings, preloads and stiffnesses moved
        within their tolerances; a loop whose stiffness moved has a curve of its own.
    """
    moved = {
        (t.place, t.quantity): t.axis.value(z)
        for t, z in problem.moved(model)
        if abs(t.axis.value(z) - t.axis.centre) > 1e-4 * t.axis.scale
    }
    pulleys = tuple(
        replace(
            p,
            inertia=p.inertia * moved.get((f'pulley_{p.name}', 'inertia'), 1.0),
            damping=max(0.0, p.damping + moved.get((f'pulley_{p.name}', 'damping'), 0.0)),
        )
        for p in instrument.pulleys
    )
    curves = {c.name: c for c in instrument.curves}
    loops = []
    for loop in instrument.loops:
        place = f'cable_{loop.name}'
        scale = moved.get((place, 'stiffness'), 1.0)
        own = loop.curve
        if scale != 1.0:
            old = curves[loop.curve]
            own = f'{old.name}_{loop.name}'
            curves[own] = Curve(own, old.elongation, tuple(scale * t for t in old.tension))
        tight = loop.pretension * moved.get((place, 'pretension'), 1.0)
        loops.append(replace(loop, curve=own, pretension=tight))
    contacts = tuple(
        replace(
            c,
            stiffness=c.stiffness * moved.get((contact_place(instrument, c), 'stiffness'), 1.0),
        )
        for c in instrument.contacts
    )
    accepted = [model.causes[k].use(model.values(k)) for k in sorted(believed)]
    places = {use.place for use in accepted}
    shapes = [use for use in bristles(model) if use.place in places]
    used = {loop.curve for loop in loops}
    return replace(
        instrument,
        pulleys=pulleys,
        loops=tuple(loops),
        curves=tuple(c for name, c in curves.items() if name in used),
        contacts=contacts,
        effects=(*instrument.effects, *accepted, *shapes),
    )
