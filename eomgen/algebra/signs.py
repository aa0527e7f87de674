"""Which graph nodes are known to be positive: from their form, and from the values of arguments."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from eomgen.algebra.graph import Node


@dataclass(frozen=True)
class Signs:
    """positive: leaves whose values are positive."""

    positive: frozenset[Node]

    def is_positive(self, node: Node) -> bool:
        """Whether the value is above zero wherever it is defined; False: not known."""
        return self._holds(node, self.is_positive)

    def is_not_negative(self, node: Node) -> bool:
        """Whether the value is zero or above wherever it is defined; False: not known."""
        if node.operator in ("sqrt", "abs") or (
            node.operator == "multiply" and node.operands[0] is node.operands[1]
        ):
            return True
        return self._holds(node, self.is_not_negative)

    def _holds(self, node: Node, claim: Callable[[Node], bool]) -> bool:
        """The claim, which is one of the two, from what the operands are."""
        operands = node.operands
        match node.operator:
            case "number":
                return bool(node.datum > 0)
            case "read":
                return node in self.positive
            case "add":
                first, second = operands
                return any(
                    claim(a) and self.is_not_negative(b)
                    for a, b in ((first, second), (second, first))
                )
            case "multiply" | "divide":
                return all(map(claim, operands))
            case "sqrt" | "abs":
                return claim(operands[0])
        return node.operator in ("exp", "cosh", "pi")
