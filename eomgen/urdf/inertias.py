"""Inertias that no body can have: refused, or mended where that is asked for.

The second moments of the mass, S = tr(J)/2 - J, are semidefinite. S + d belongs to J + 2 d.
"""

from dataclasses import replace
from decimal import ROUND_CEILING, Context, Decimal

import numpy as np
import sympy as sp

from eomgen.spec.inertias import ORDER, check_possible
from eomgen.spec.ledger import Mistake, shown
from eomgen.urdf.notes import Notes
from eomgen.urdf.numbers import written
from eomgen.urdf.robot import Inertial, Link

LONG = Context(prec=20, rounding=ROUND_CEILING)
SHORT = Context(prec=4, rounding=ROUND_CEILING)  # of what is added
PLACES = ORDER[6]


def check(link: str, inertial: Inertial) -> None:
    """Raise `Mistake` where no body can have the inertia."""
    entries = [inertial.inertia[i] for i in PLACES if i is not None]
    exact = [sp.Rational(*entry.as_integer_ratio()) for entry in entries]
    try:
        check_possible(exact, inertial.spot, f"the inertia of {shown(link)}")
    except Mistake as mistake:
        mistake.hint = "correct it, or --mend-inertias"
        raise


def mended(link: Link, notes: Notes) -> Link:
    """The link, its three moments of inertia raised alike by as little as makes them possible."""
    if link.inertial is None:
        return link
    inertial, least = link.inertial, _lacking(link.inertial)
    while True:
        try:
            check(link.name, inertial)
        except Mistake:
            inertial = _raised(link.inertial, least)
            least *= 2
            continue
        break
    if inertial is not link.inertial:
        by = SHORT.subtract(inertial.inertia[0], link.inertial.inertia[0]).normalize(SHORT)
        text = f"the moments of inertia of {shown(link.name)} are raised by {written(by)} kg m^2"
        notes.add(text, inertial.spot)
    return replace(link, inertial=inertial)


def _raised(inertial: Inertial, by: Decimal) -> Inertial:
    xx, yy, zz, *products = inertial.inertia
    raised = tuple(LONG.add(moment, by) for moment in (xx, yy, zz))
    return replace(inertial, inertia=(*raised, *products))


def _lacking(inertial: Inertial) -> Decimal:
    """Twice what the least second moment is below zero, rounded up to four digits."""
    entries = [float(inertial.inertia[i]) for i in PLACES if i is not None]
    tensor = np.array(entries).reshape(3, 3)
    moments = np.linalg.eigvalsh(np.eye(3) * np.trace(tensor) / 2 - tensor)
    size = float(np.abs(tensor).max())
    return SHORT.create_decimal_from_float(2 * max(-float(moments[0]), 0.0) + 1e-15 * size)
