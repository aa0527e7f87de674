"""One derivation to C text in a process of its own: `python -m lab.derive_one WHO SCENE COUNT`.

Prints processor seconds, the least of up to three, and the statements of the text. Processor time,
so that a busy machine does not count; nobody here uses two cores.
"""

from __future__ import annotations

import gc
import sys
from collections.abc import Callable
from time import process_time

from eomgen.cli import COLLECT_RARELY
from lab import masses
from lab.trees import Tree, arm, cart, skew_arm, walker

ENOUGH = 2.0  # seconds after which a derivation is not repeated
TREES: dict[str, Callable[[int], Tree]] = {
    "cart": cart,
    "arm": arm,
    "skew arm": skew_arm,
    "walker": lambda count: walker(),
}


def _spec(scene: str, count: int) -> str:
    from lab.spec_text import spec

    return masses.spec(count) if scene == "masses" else spec(TREES[scene](count))


def ours(scene: str, count: int) -> Callable[[], str]:
    """From the text of the spec, everything checked."""
    from eomgen.outputs import Wish, rendered
    from eomgen.study import of_text
    from eomgen.wanted import Wanted

    given, only = _spec(scene, count), ("accelerations",)
    wanted, wish = Wanted(functions=only), Wish(("c",), functions=only)
    return lambda: rendered(of_text(given, "scene.yaml", wanted), wish)["scene.c"]


def from_model(scene: str, count: int) -> Callable[[], str]:
    """From the model, nothing checked."""
    from eomgen import compile
    from eomgen.render.targets import TARGETS, render
    from eomgen.render.templating import environment
    from eomgen.spec import read

    model = read(_spec(scene, count), "scene.yaml")

    def derive() -> str:
        program = compile.program(compile.machine_of(model), ("accelerations",))
        return render(program, TARGETS["c"], environment(None))["scene.c"]

    return derive


def kane(scene: str, count: int) -> Callable[[], str]:
    """SymPy's KanesMethod, cse and C printing."""
    import sympy as sp
    from sympy.core.cache import clear_cache

    from lab import sympy_kane

    def derive() -> str:
        clear_cache()
        found = (
            sympy_kane.masses(count)
            if scene == "masses"
            else sympy_kane.derive(TREES[scene](count))
        )
        plain = {e: sp.Symbol(e.func.__name__) for e in found.arguments}
        entries = [e.xreplace(plain) for e in [*found.mass_matrix, *found.forcing]]
        shared, results = sp.cse(entries)
        lines = [f"const double {s} = {sp.ccode(e)};" for s, e in shared]
        return "\n".join(lines + [f"r[{i}] = {sp.ccode(e)};" for i, e in enumerate(results)])

    return derive


def symengine(scene: str, count: int) -> Callable[[], str]:
    """The same equations on SymEngine."""
    from lab import symengine_kane as kane

    if scene == "masses":
        return lambda: kane.text(kane.masses(count))
    return lambda: kane.text(kane.equations(TREES[scene](count)))


def casadi(solver: str) -> Callable[[str, int], Callable[[], str]]:
    """CasADi's graph and its C."""

    def start(scene: str, count: int) -> Callable[[], str]:
        from lab import casadi_c, casadi_planar, casadi_spatial
        from lab.frames import plain

        def derive() -> str:
            if scene == "masses":
                return casadi_c.generated(masses.sx_function(count))
            tree = TREES[scene](count)
            if tree.planar:
                made = casadi_planar.function(tree, casadi_c.PLANAR[f"planar {solver}"])
            else:
                made = casadi_spatial.function(tree, plain(tree), casadi_c.SPATIAL[solver])
            return casadi_c.generated(made)

        return derive

    return start


WHO: dict[str, Callable[[str, int], Callable[[], str]]] = {
    "ours, checked": ours,
    "ours, from the model": from_model,
    "KanesMethod": kane,
    "SymEngine": symengine,
    "CasADi, articulated": casadi("articulated"),
    "CasADi, composite": casadi("composite"),
}


def main(who: str, scene: str, count: str) -> None:
    """Measure; cyclic garbage is collected as rarely as our command line does, for everyone."""
    gc.set_threshold(COLLECT_RARELY)
    derive = WHO[who](scene, int(count))
    best, spent, text = float("inf"), 0.0, ""
    for _ in range(3):
        gc.collect()
        start = process_time()
        text = derive()
        took = process_time() - start
        best, spent = min(best, took), spent + took
        if spent > ENOUGH:
            break
    print(best, sum(line.rstrip().endswith(";") for line in text.splitlines()))


if __name__ == "__main__":
    main(*sys.argv[1:])
