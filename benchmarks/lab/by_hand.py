"""What a person would write in C for the cart with pendulums."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from lab.build import Source
from lab.contestants import Contestant
from lab.trees import Tree


def contestants(tree: Tree) -> Iterator[Contestant]:
    """The recursion over the tensions of the rods, in loops."""
    if not tree.planar:
        return
    text = (Path(__file__).parent / "native" / "planar_run.c").read_text(encoding="utf-8")
    source = Source({"run.c": text, "values.h": _values(tree)}, "run.c")
    yield Contestant("by hand, O(n), planar", "tensions", source, absolute=True)


def _values(tree: Tree) -> str:
    masses = ", ".join(repr(float(link.mass)) for link in tree.links)
    lengths = ", ".join(repr(-float(link.com[1])) for link in tree.links)
    return (
        f"enum {{ N = {len(tree.links) - 1} }};\n"
        f"static const double MASS[] = {{{masses}}}, LENGTH[] = {{{lengths}}};\n"
        f"static const double GRAVITY = {-float(tree.gravity[1])!r};\n"
    )
