"""Table 1 and the numbers of the text that describe the rig: that the file took them over."""

from __future__ import annotations

from tendon_ros.model.instrument import Instrument
from tendon_ros.model.paper.statement import about, Statement, Use


def table_one(rig: Instrument) -> tuple[Statement, ...]:
    """
    Return what the paper says of its rig, beside what the instrument file holds.

    :param rig: the instrument.
    :return: statements, all inputs.
    """
    radii = {abs(radius) for loop in rig.loops for radius in loop.route.values()}
    small = {p.inertia for p in rig.pulleys if p.name != '3'}
    [third] = [p.inertia for p in rig.pulleys if p.name == '3']
    dampings = {p.damping for p in rig.pulleys}
    rows = (
        ('radius of pulleys M, L, 1, 2, 3', '30 mm', 1e3, radii, 'mm', 30.0, ''),
        ('inertia of M, L, 1, 2', '2.25e-4 "kg m"', 1.0, small, 'kg m^2', 2.25e-4, 'kg m^2 meant'),
        ('inertia of 3', '4e-2 "kg m"', 1.0, {third}, 'kg m^2', 4e-2, 'kg m^2 meant'),
        ('arm of the end-effector', '50', 1e3, {rig.contacts[0].arm}, 'mm', 50.0, 'mm meant'),
        ('damping B', '0.9', 1.0, dampings, 'N m s/rad', 0.9, 'no unit printed; see Fig. 10'),
    )
    return tuple(
        Statement(
            'Table 1' if what != 'damping B' else 'text',
            what,
            said,
            # one value for all of them, or a number that cannot hold
            factor * values.pop() if len(values) == 1 else float('nan'),
            unit,
            within=about(value, 1e-9 * value),
            use=Use.INPUT,
            note=note,
        )
        for what, said, factor, values, unit, value, note in rows
    )
