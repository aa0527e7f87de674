"""What the templates of integrators are given: text, numbers and records of these."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, replace
from fractions import Fraction

from eomgen.integrators.methods import MIDPOINT_ITERATIONS, Method
from eomgen.integrators.steps import Steps
from eomgen.integrators.tableaus import Rosenbrock, Tableau
from eomgen.program import OPERATORS
from eomgen.render import steps_cost
from eomgen.render.code import literal
from eomgen.render.names import prefix
from eomgen.render.routines import COUNTED

WORD = 8  # bytes of a double


@dataclass(frozen=True)
class Stage:
    """One evaluation of an explicit method."""

    name: str
    time: str
    sum: str  # of the stages before; empty for the first


@dataclass(frozen=True)
class MethodText:
    """A method as the templates write it."""

    name: str
    spelled: str
    kind: str
    order: int
    about: str
    notes: tuple[str, ...]
    operations: str
    stack: int
    stages: tuple[Stage, ...] = ()
    sum: str = ""
    gamma: str = ""


def c(steps: Steps) -> dict[str, object]:
    """The names of the C templates of integrators."""
    kinds = {m.kind for m in steps.methods}
    return {
        "name": steps.name,
        "prefix": prefix(steps.name),
        "title": steps.program.title,
        "digest": steps.program.digest,
        "version": steps.program.version,
        "methods": tuple(_text(steps, m) for m in steps.methods),
        "compensated": steps.compensated,
        "canonical": steps.is_canonical,
        "rates_apart": steps.has("rates"),
        "projects": steps.projects_positions or steps.has("project_rates"),
        "projects_positions": steps.projects_positions,
        "projects_rates": steps.has("project_rates"),
        "guarded": steps.has("constraint_margin"),
        "residuals": steps.residuals,
        "implicit": bool(kinds & {"rosenbrock", "midpoint"}),
        "damped": "semi_euler_damped" in kinds,
        "newton": "midpoint" in kinds,
        "iterations": MIDPOINT_ITERATIONS,
    }


def _text(steps: Steps, method: Method) -> MethodText:
    made = MethodText(
        name=method.name,
        spelled=method.spelled,
        kind=method.kind,
        order=method.order,
        about=method.about,
        notes=NOTES[method.kind](steps),
        operations=_counted(steps_cost.cost(steps, method)),
        stack=WORD * steps_cost.words(steps, method),
    )
    if isinstance(method.table, Rosenbrock):
        return replace(made, gamma=f"REAL({method.table.gamma!r})")
    if isinstance(method.table, Tableau):
        stages = tuple(_stage(method.table, i) for i in range(len(method.table.b)))
        return replace(made, stages=stages, sum=_sum(method.table.b))
    return made


def _stage(table: Tableau, index: int) -> Stage:
    node = table.c[index]
    times = {Fraction(0): "t", Fraction(1): "t + h"}
    time = times.get(node, f"t + REAL({literal(node)}) * h")
    return Stage(f"k{index + 1}", time, _sum(table.a[index]))


def _sum(coefficients: tuple[Fraction, ...]) -> str:
    """Sum of coefficient * k, without those that are zero."""
    parts = [
        (
            "-" if a < 0 else "+",
            f"k{j + 1}[i]" if abs(a) == 1 else f"REAL({literal(abs(a))}) * k{j + 1}[i]",
        )
        for j, a in enumerate(coefficients)
        if a
    ]
    text = " ".join(f"{sign} {term}" for sign, term in parts)
    return text.removeprefix("+ ") if not text.startswith("- ") else f"-{text.removeprefix('- ')}"


def _counted(counts: Counter[str]) -> str:
    """Operations in the order of `OPERATORS`, as the functions of a program state theirs."""
    shown: dict[str, int] = {}
    for operator in OPERATORS:
        if counts[operator] and operator != "pi":
            sign = COUNTED.get(operator, operator)
            shown[sign] = shown.get(sign, 0) + counts[operator]
    return ", ".join(f"{n} {sign}" for sign, n in shown.items())


def _semi_euler_notes(steps: Steps) -> tuple[str, ...]:
    return ("Not symplectic where M depends on the coordinates.",)


def _midpoint_notes(steps: Steps) -> tuple[str, ...]:
    kept = "Symplectic, on the momenta p = dT/dq'." if steps.is_canonical else "Of the state."
    return (kept, f"{MIDPOINT_ITERATIONS} simplified Newton iterations.")


def _damped_notes(steps: Steps) -> tuple[str, ...]:
    return ("(M + h D) (u+ - u) = h (Q - bias), D = -dQ/du.", *_semi_euler_notes(steps))


NOTES: dict[str, Callable[[Steps], tuple[str, ...]]] = {
    "explicit": lambda steps: (),
    "semi_euler": _semi_euler_notes,
    "semi_euler_damped": _damped_notes,
    "verlet": lambda steps: ("Symplectic: M is constant, the forces depend on positions only.",),
    "rosenbrock": lambda steps: ("Linearly implicit, one factorisation.",),
    "midpoint": _midpoint_notes,
}
