"""The order in which values are computed: each near its use, so that few are alive at a time."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from eomgen.algebra.graph import Node, below

Stop = Callable[[Node], bool]
Followers = Mapping[Node, tuple[Node, ...]]


def depth_first(roots: Sequence[Node], stop: Stop, followers: Followers) -> list[Node]:
    """All nodes below `roots` but not below one that satisfies `stop`, operands first.

    Of several operands the one that needs the most registers is computed first (Sethi and Ullman,
    The generation of optimal code for arithmetic expressions, J. ACM 17, 1970); shared values
    make that a heuristic. The followers of a node are computed right behind it.
    """
    operands = _ranked(below(roots, stop), stop)
    placed: dict[Node, None] = {}
    for root in roots:
        _place(root, operands, followers, placed)
    return list(placed)


def _ranked(nodes: Sequence[Node], stop: Stop) -> dict[Node, tuple[Node, ...]]:
    """The operands of every node, the one that needs the most registers first."""
    needs: dict[Node, int] = {}
    ranked: dict[Node, tuple[Node, ...]] = {}
    for node in nodes:
        operands = () if stop(node) else node.operands
        order = sorted(dict.fromkeys(operands), key=needs.__getitem__, reverse=True)
        ranked[node] = tuple(order)
        needs[node] = max((needs[a] + i for i, a in enumerate(order)), default=0) or len(order[:1])
    return ranked


def _place(
    root: Node,
    operands: Mapping[Node, tuple[Node, ...]],
    followers: Followers,
    placed: dict[Node, None],
) -> None:
    """Place a node behind everything below it; with a stack, as graphs are deep."""
    stack = [(root, False)]
    while stack:
        node, is_ready = stack.pop()
        if node in placed:
            continue
        if is_ready:
            placed[node] = None
            stack.extend((a, False) for a in reversed(followers.get(node, ())))
        else:
            stack.append((node, True))
            stack.extend((a, False) for a in reversed(operands[node]) if a not in placed)
