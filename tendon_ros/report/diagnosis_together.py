"""Which effects together do what one alone does, in words."""

from __future__ import annotations

from tendon_ros.diagnose.result import Cause, Diagnosis
from tendon_ros.diagnose.together import partner
from tendon_ros.effects import find
from tendon_ros.report.diagnosis_words import effect_words, inside, with_unit


def together(diagnosis: Diagnosis, cause: Cause) -> str:
    """
    Return which effects would together do what a cause does, or what it does with another one.

    :param diagnosis: the answer that the cause is part of.
    :param cause: an effect that was found.
    :return: a sentence without its full stop; empty where there are none.
    """
    effect = find(cause.effect)
    if effect.alike is None:
        if (found := partner(diagnosis, cause)) is None:
            return ''
        beside, alone = (inside(effect_words(o.effect, o.place)) for o in found)
        return f'with {beside} it does what {alone} alone does, and these channels cannot tell'
    sizes = effect.alike(**{name: found.value for name, found in cause.parameters.items()})
    units = {name: find(name).parameters[0].unit for name in sizes}
    parts = [
        f'{inside(find(name).title)} of {with_unit(size, units[name])}'
        for name, size in sizes.items()
    ]
    told = not set(sizes) <= {c.effect for c in cause.indistinguishable}
    end = 'would do the same' if told else 'do the same, and these channels cannot tell'
    return f'{" and ".join(parts)} together {end}'
