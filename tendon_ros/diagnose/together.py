"""Sets of causes in which two do together what one alone does."""

from __future__ import annotations

from tendon_ros.diagnose.result import Candidate, Cause, Diagnosis
from tendon_ros.effects import find


def partner(diagnosis: Diagnosis, cause: Cause) -> tuple[Cause, Candidate] | None:
    """
    Return with whom a cause does what one effect alone would do.

    :param diagnosis: the answer that the cause is part of.
    :param cause: an effect that was found.
    :return: the other cause and that one effect, of which neither can be told; None without.
    """
    for whole in cause.indistinguishable:
        both = find(whole.effect).parts
        for other in diagnosis.causes:
            apart = other.effect != cause.effect and {other.effect, cause.effect} <= both
            if apart and whole in other.indistinguishable:
                return other, whole
    return None


def alone(diagnosis: Diagnosis, cause: Cause) -> tuple[Candidate, ...]:
    """
    Return what would take a cause's place by itself, and nothing else.

    :param diagnosis: the answer that the cause is part of.
    :param cause: an effect that was found.
    :return: those that cannot be told from it, without who does the same beside another one only.
    """
    both = find(cause.effect).parts
    found = partner(diagnosis, cause)
    whole = found[1] if found else None
    together = both and both <= {c.effect for c in cause.indistinguishable}
    return tuple(
        c for c in cause.indistinguishable if c != whole and not (together and c.effect in both)
    )
