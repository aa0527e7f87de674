"""The principle of virtual work in closed form: sum of (Q_j + lambda_a J_aj) delta q_j = 0.

At rest: every rate is zero, prescribed motions and the time stand still, as they do in a virtual
displacement. All applied forces count, weights and springs too; ideal constraint forces do not.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import sympy as sp

from eomgen.algebra import normal
from eomgen.algebra.arithmetic import over
from eomgen.algebra.closed import ClosedForm, Evaluation
from eomgen.algebra.normal import Form, Kernel
from eomgen.algebra.scalar import S
from eomgen.analysis.equilibrium_records import Balance, Link, Statics
from eomgen.errors import UsageError
from eomgen.mechanics import constraints, efforts, motions
from eomgen.mechanics.equations import Contribution
from eomgen.mechanics.kinematics import Flow, Kinematics
from eomgen.mechanics.lagrange import Lagrangian, closed_kinematics, virtual_symbol
from eomgen.model import TIME, Coordinate, Model

MOVING = (
    "motion is prescribed: it stands still at the given time, and its inertia loads are no applied "
    "forces; a steady motion (relative equilibrium) is not an equilibrium of applied forces"
)
FROZEN = "forces or constraints depend on time: they stand still at the given time"
FRICTION = "friction is left out: with it, equilibria spread over a region"


def frozen(kinematics: Kinematics[S]) -> Kinematics[S]:
    """The kinematics of virtual displacements: only coordinates move."""
    flow = kinematics.flow
    moving = {c.symbol: flow.rates[c.symbol] for c in kinematics.model.coordinates}
    return Kinematics(kinematics.model, kinematics.algebra, Flow(flow.rates, moving))


def symbols_of(form: Form) -> set[sp.Symbol]:
    """Every symbol of a form, inside functions and angles too."""
    found: set[sp.Symbol] = set()
    for atom in (form.ring.atoms[a] for a in normal.atoms_of(form)):
        if isinstance(atom, Kernel):
            found = found.union(*(symbols_of(a) for a in atom.arguments))
        elif isinstance(atom, sp.Symbol):
            found.add(atom)
    return found


@dataclass(frozen=True)
class Substitution:
    """Puts forms in the place of symbols; other symbols stay."""

    algebra: ClosedForm
    values: Mapping[sp.Symbol, Form]

    def of(self, form: Form) -> Form:
        """The form with the values put in."""
        if not symbols_of(form) & self.values.keys():
            return form
        arithmetic = over(self.algebra)
        values = _Kept(self.algebra, self.values)
        functions = arithmetic.functions
        result: Form = Evaluation(
            values, self.algebra.number, lambda name, *a: functions[name](*a)
        ).of(form)
        return result


class _Kept(dict[sp.Symbol, Form]):
    """Values by symbol; a symbol without one is itself."""

    def __init__(self, algebra: ClosedForm, values: Mapping[sp.Symbol, Form]) -> None:
        super().__init__(values)
        self.algebra = algebra

    def __missing__(self, symbol: sp.Symbol) -> Form:
        return normal.of_atom(self.algebra.ring, symbol)


def equations(model: Model) -> Statics:
    """The equilibrium equations of a scene.

    Raises:
        UsageError: a force is not defined at rest.
    """
    kinematics = frozen(closed_kinematics(model))
    assert isinstance(kinematics.algebra, ClosedForm)
    lagrangian = Lagrangian(kinematics)
    rest = Substitution(kinematics.algebra, _at_rest(model, kinematics.algebra))
    links = tuple(_link(kinematics, rest, row) for row in constraints.rows(kinematics))
    balances = tuple(_balance(lagrangian, rest, links, j) for j, _ in enumerate(model.coordinates))
    return Statics(
        model=model,
        work=_work(lagrangian, rest),
        balances=balances,
        links=links,
        conservative=_has_potential(lagrangian, [b.force for b in balances]),
        notes=_notes(model, balances, links),
    )


def _at_rest(model: Model, algebra: ClosedForm) -> dict[sp.Symbol, Form]:
    """Zero for the rate of everything that moves."""
    still = [c.rate for c in model.coordinates]
    still += [s for p in model.prescribed for s in (p.rate, p.acceleration)]
    return dict.fromkeys(still, algebra.number(0))


def _resting(rest: Substitution, form: Form, name: str) -> Form:
    try:
        return rest.of(form)
    except ZeroDivisionError as error:
        raise UsageError(
            f"the force on {name} is not defined at rest: it divides by a rate; "
            "write it so that it is zero, or some value, at rest"
        ) from error


def _link(kinematics: Kinematics[Form], rest: Substitution, row: constraints.Row[Form]) -> Link:
    return Link(
        name=row.name,
        constraint=row.constraint,
        residual=None if row.residual is None else rest.of(row.residual),
        jacobian=tuple(rest.of(entry) for entry in row.jacobian),
        multiplier=sp.Symbol(f"lambda {row.name}", real=True),
    )


def _balance(
    lagrangian: Lagrangian, rest: Substitution, links: tuple[Link, ...], index: int
) -> Balance:
    algebra = lagrangian.kinematics.algebra
    coordinate = lagrangian.kinematics.model.coordinates[index]
    motion = motions.of(lagrangian.kinematics.model, algebra)[index]
    name = coordinate.name

    def slope(kind: str) -> Form:
        shares = (s for s in lagrangian.potential if s.kind == kind)
        return lagrangian.partial(lagrangian.sum(shares), coordinate.symbol)

    damping = lagrangian.partial(lagrangian.dissipation_function, coordinate.rate)
    shares = (algebra.of(link.multiplier) * link.jacobian[index] for link in links)
    return Balance(
        name=name,
        elastic=slope("spring"),
        gravity=slope("gravity"),
        other=slope("formula"),
        damping=_resting(rest, damping, name),
        applied=_resting(rest, lagrangian.force(motion), name),
        reaction=normal.total(rest.algebra.ring, shares),
    )


def _work(lagrangian: Lagrangian, rest: Substitution) -> tuple[Contribution[Form], ...]:
    """dW of every weight, spring, force and moment; what does no work is left out."""
    shares = [
        Contribution(
            s.name,
            s.kind,
            _displaced(lagrangian, lambda c, s=s: -lagrangian.partial(s.value, c.symbol)),
        )
        for s in lagrangian.potential
    ]
    for effort in lagrangian.efforts:

        def force(c: Coordinate, effort: efforts.Effort[Form] = effort) -> Form:
            found = efforts.generalized_force(lagrangian.kinematics, effort, c.rate)
            return _resting(rest, found, c.name)

        shares.append(Contribution(effort.name, effort.kind, _displaced(lagrangian, force)))
    return tuple(s for s in shares if s.value.terms)


def _displaced(lagrangian: Lagrangian, force: object) -> Form:
    """Sum of force_j delta q_j."""
    assert callable(force)
    algebra = lagrangian.kinematics.algebra
    return lagrangian.sum(
        Contribution(c.name, "", force(c) * algebra.of(virtual_symbol(c)))
        for c in lagrangian.kinematics.model.coordinates
    )


def _has_potential(lagrangian: Lagrangian, forces: list[Form]) -> bool:
    """Whether dQ_i/dq_j = dQ_j/dq_i, decided."""
    symbols = [c.symbol for c in lagrangian.kinematics.model.coordinates]
    return all(
        normal.is_zero(
            lagrangian.partial(forces[i], symbols[j]) - lagrangian.partial(forces[j], symbols[i])
        )
        for i in range(len(forces))
        for j in range(i)
    )


def _notes(model: Model, balances: Iterable[Balance], links: Iterable[Link]) -> tuple[str, ...]:
    """What the equations leave out."""
    notes = []
    forms = [b.force for b in balances]
    for link in links:
        forms += [*link.jacobian, *([] if link.residual is None else [link.residual])]
    held: set[sp.Symbol] = set().union(*(symbols_of(f) for f in forms))
    driven = {TIME, *(p.symbol for p in model.prescribed)}
    links_driven = any(symbols_of(r.residual) & driven for r in links if r.residual is not None)
    if links_driven or _is_driven(model):
        notes.append(MOVING)
    elif held & driven:
        notes.append(FROZEN)
    if any(c.friction is not None for c in model.constraints):
        notes.append(FRICTION)
    return tuple(notes)


def _is_driven(model: Model) -> bool:
    """Whether the scene has kinetic energy while every rate is zero."""
    kinematics = closed_kinematics(model)
    assert isinstance(kinematics.algebra, ClosedForm)
    zero = kinematics.algebra.number(0)
    still = Substitution(kinematics.algebra, {c.rate: zero for c in model.coordinates})
    return bool(still.of(Lagrangian(kinematics).kinetic_energy).terms)
