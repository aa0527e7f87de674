"""CasADi's own C of our SX functions, as contestants."""

from __future__ import annotations

from collections.abc import Iterator

import casadi as ca

from lab import casadi_articulated, casadi_composite, casadi_planar, casadi_spatial
from lab.build import Source
from lab.contestants import Contestant
from lab.frames import aligned, is_straight, plain
from lab.trees import Tree

SPATIAL = {"articulated": casadi_articulated.solve, "composite": casadi_composite.solve}
PLANAR = {
    "planar articulated": casadi_planar.articulated,
    "planar composite": casadi_planar.composite,
}

# inlined where nothing is null, so that the generated tests for null pointers cost nothing
ADAPTER = """\
#define CASADI_SYMBOL_EXPORT static inline __attribute__((always_inline))
#include "fd.c"

__attribute__((nonnull)) void run(const double *state, const double *inputs, double *result)
{
    const double *arguments[] = {state, inputs};
    double *results[] = {result};
    fd(arguments, results, 0, 0, 0);
}
"""


def generated(function: ca.Function) -> str:
    """The C text of a function."""
    generator = ca.CodeGenerator("fd.c", {"with_header": False})
    generator.add(function)
    return str(generator.dump())


def functions(tree: Tree) -> dict[str, ca.Function]:
    """Every way in which we wrote a tree's forward dynamics."""
    axes = {"": plain(tree)}
    if any(not is_straight(link.axis) for link in axes[""]):
        axes[", axes turned"] = aligned(tree)
    made = {
        name + how: casadi_spatial.function(tree, links, solver)
        for name, solver in SPATIAL.items()
        for how, links in axes.items()
    }
    if tree.planar:
        made |= {name: casadi_planar.function(tree, solver) for name, solver in PLANAR.items()}
    return made


def contestants(tree: Tree) -> Iterator[Contestant]:
    """The C that CasADi writes, constants folded."""
    for variant, function in functions(tree).items():
        source = Source({"run.c": ADAPTER, "fd.c": generated(function)}, "run.c")
        yield Contestant("CasADi", variant, source, absolute=variant in PLANAR)
