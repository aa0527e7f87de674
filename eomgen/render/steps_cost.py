"""What a step of an integrator costs: operations, exactly counted, and numbers on the stack."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable

from eomgen.integrators.methods import MIDPOINT_ITERATIONS, Method
from eomgen.integrators.steps import Steps
from eomgen.integrators.tableaus import Tableau
from eomgen.program import Assign, Function, Solve
from eomgen.render.lowered import defined, lower, operations


def cost(steps: Steps, method: Method) -> Counter[str]:
    """How often one step applies each operator, everything included."""
    total = OWN[method.kind](steps, method)
    functions = {f.name: f for f in steps.program.functions}
    for name, count in steps.calls(method).items():
        for operator, times in _operations(functions[name]).items():
            total[operator] += count * times
    total["add"] += steps.size
    return total


def _operations(function: Function) -> Counter[str]:
    """The operations of a function, those of its loops too."""
    found = operations(lower(function))
    for statement in function.statements:
        if isinstance(statement, Solve):
            n = len(statement.names)
            found["divide"] += n * (n - 1) // 2 + n
            products = n * (n - 1) * (n + 1) // 6 + n * (n - 1)
            found["multiply"] += products
            found["subtract"] += products
    return found


def _explicit_cost(steps: Steps, method: Method) -> Counter[str]:
    assert isinstance(method.table, Tableau)
    n, rows = steps.size, [*filter(any, method.table.a), method.table.b]
    terms = sum(1 for row in rows for a in row if a)
    units = sum(1 for row in rows for a in row if abs(a) == 1)
    return Counter(multiply=n * (terms - units + len(rows)), add=n * (terms - 1))


def _semi_euler_cost(steps: Steps, method: Method) -> Counter[str]:
    return Counter(multiply=steps.size, add=len(steps.program.speeds))


def _verlet_cost(steps: Steps, method: Method) -> Counter[str]:
    n = len(steps.program.speeds)
    return Counter(multiply=5 * n, add=2 * n)


def _factored(n: int) -> Counter[str]:
    """1 - scale J and its factors."""
    inner = sum((n - k - 1) ** 2 for k in range(n))
    return Counter(multiply=n * n + inner + n * (n - 1) // 2, subtract=n * n + inner, divide=n)


def _substituted(n: int) -> Counter[str]:
    return Counter(multiply=n * (n - 1), subtract=n * (n - 1), divide=n)


def _damped_cost(steps: Steps, method: Method) -> Counter[str]:
    n = len(steps.program.speeds)
    return _semi_euler_cost(steps, method) + _factored(n) + _substituted(n)


def _times(count: int, one: Counter[str]) -> Counter[str]:
    return Counter({operator: count * times for operator, times in one.items()})


def _rosenbrock_cost(steps: Steps, method: Method) -> Counter[str]:
    n = steps.size
    own = Counter(multiply=5 * n, add=2 * n, subtract=n)
    return own + _factored(n) + _times(2, _substituted(n))


def _midpoint_cost(steps: Steps, method: Method) -> Counter[str]:
    n = steps.size
    iteration = _substituted(n) + Counter(multiply=n, add=3 * n, subtract=n, divide=n)
    return _factored(n) + _times(MIDPOINT_ITERATIONS, iteration) + Counter(multiply=n)


OWN: dict[str, Callable[[Steps, Method], Counter[str]]] = {
    "explicit": _explicit_cost,
    "semi_euler": _semi_euler_cost,
    "semi_euler_damped": _damped_cost,
    "verlet": _verlet_cost,
    "rosenbrock": _rosenbrock_cost,
    "midpoint": _midpoint_cost,
}


def words(steps: Steps, method: Method) -> int:
    """Arrays of a step, of what follows it, and the named values of its largest function."""
    n = steps.size
    functions = {f.name: f for f in steps.program.functions}
    below = max(map(_named, (functions[name] for name in steps.calls(method))), default=0)
    ending = n * (2 + steps.compensated) + steps.residuals
    return ARRAYS[method.kind](steps, method) + ending + below


def _named(function: Function) -> int:
    """Numbers that a function may hold at once: arguments, named values, results."""
    names = sum(len(defined(s)) for s in lower(function).statements if isinstance(s, Assign))
    loops = [s for s in function.statements if isinstance(s, Solve)]
    return names + sum(len(s.matrix) + 3 * len(s.right) for s in loops) + 2 * len(function.results)


ARRAYS: dict[str, Callable[[Steps, Method], int]] = {
    "explicit": lambda steps, method: steps.size * (1 + len(method.table.b)),  # type: ignore[union-attr]
    "semi_euler": lambda steps, method: 3 * steps.size,
    "semi_euler_damped": lambda steps, method: (
        3 * steps.size + len(steps.program.speeds) * (len(steps.program.speeds) + 1)
    ),
    "verlet": lambda steps, method: 2 * steps.size,
    "rosenbrock": lambda steps, method: steps.size * (steps.size + 4),
    "midpoint": lambda steps, method: steps.size * (steps.size + 6),
}
