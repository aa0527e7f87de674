"""Degrees of freedom with proof: the rank of the rows at several admissible states, in 50 digits.

Degrees of freedom are the independent virtual displacements, n - rank of all rows; the least number
of coordinates is n - rank of what holds between positions, hidden relations included.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from eomgen.analysis import admissible, elimination, singular, virtual
from eomgen.analysis import linkage as linkages
from eomgen.analysis.admissible import Admissible
from eomgen.analysis.elimination import Matrix
from eomgen.analysis.linkage import Linkage
from eomgen.analysis.neighbourhood import row_sizes
from eomgen.analysis.singular import Singularity
from eomgen.analysis.virtual import Basis
from eomgen.compile import Machine
from eomgen.errors import UsageError

STATES = 5
VANISHING = 1e-15


@dataclass(frozen=True)
class Dependency:
    """A row that follows from others and is dropped."""

    row: str
    on: tuple[str, ...]

    def __str__(self) -> str:
        """The warning, with its code."""
        group = (*self.on, self.row)
        return (
            f"W-RANK: constraint {self.row} depends on {', '.join(self.on)} "
            f"(rank {len(self.on)} of {len(group)}); dropped. "
            f"Reaction forces of {', '.join(group)} are not unique."
        )


@dataclass(frozen=True)
class Freedom:
    """How much is free, and how it is known."""

    coordinates: int  # n
    rows: tuple[str, ...]  # holonomic rows first
    rank_holonomic: int  # as stated, without hidden relations
    rank: int  # of all rows
    hidden: int  # relations between positions that rate constraints imply
    dependencies: tuple[Dependency, ...]
    singularities: tuple[Singularity, ...]
    basis: Basis
    states: int  # admissible states at which the rank was found

    @property
    def degrees_of_freedom(self) -> int:
        """The number of independent virtual displacements."""
        return self.coordinates - self.rank

    @property
    def minimal_coordinates(self) -> int:
        """The least number of coordinates that say where everything is."""
        return self.coordinates - self.rank_holonomic - self.hidden

    @property
    def dropped(self) -> tuple[str, ...]:
        """Names of the rows that follow from the others."""
        return tuple(d.row for d in self.dependencies)

    @property
    def warnings(self) -> tuple[str, ...]:
        """Every warning, with its code."""
        return tuple(str(w) for w in (*self.dependencies, *self.singularities))


def freedom(
    machine: Machine, states: Sequence[Admissible] | None = None, hidden: int = 0
) -> Freedom:
    """The degrees of freedom of a scene; `hidden` relations are counted by `integrability`.

    Raises:
        UsageError: no admissible state, or more independent constraints than coordinates.
    """
    linkage = linkages.of(machine)
    drawn = admissible.draw(machine, STATES) if states is None else states
    matrices = [linkages.jacobian(linkage, s.state) for s in drawn]
    _refuse_vanishing(linkage, drawn[0], matrices[0])
    holonomic = len(linkage.holonomic)
    names = tuple(row.name for row in linkage.rows)
    ranks = [elimination.rank(m) for m in matrices]
    found = dependencies(matrices)
    kept = tuple(i for i in range(len(names)) if i not in found)
    n = len(linkage.model.coordinates)
    if len(names) > n == max(ranks, default=0):
        raise UsageError(
            f"{len(names)} constraints ({', '.join(names)}) hold {n} coordinates fast and nothing "
            "can move; remove constraints"
        )
    return Freedom(
        coordinates=n,
        rows=names,
        rank_holonomic=max((elimination.rank(m[:holonomic]) for m in matrices), default=0),
        rank=max(ranks, default=0),
        hidden=hidden,
        dependencies=tuple(
            Dependency(names[i], tuple(names[k] for k in on)) for i, on in found.items()
        ),
        singularities=singular.find(linkage, [s.state for s in drawn], kept),
        basis=virtual.basis(linkage, [s.state for s in drawn], kept),
        states=len(drawn),
    )


def _refuse_vanishing(linkage: Linkage, drawn: Admissible, matrix: Matrix) -> None:
    """A row such as (x - y)^2 = 0 has no gradient where it holds: it cannot bind any rate."""
    sizes = row_sizes(linkage, drawn.state)
    for row, size, entries in zip(linkage.rows, sizes, matrix, strict=True):
        if max(abs(v) for v in entries) <= VANISHING * size:
            raise UsageError(
                f"constraint {row.name} has no gradient where it holds, so it binds no rate; "
                "write it without the power, or remove it if it mentions no coordinate"
            )


def kept_rows(linkage: Linkage, states: Sequence[Admissible]) -> tuple[int, ...]:
    """The numbers of the rows that are left when dependent ones are dropped."""
    found = dependencies([linkages.jacobian(linkage, s.state) for s in states])
    return tuple(i for i in range(len(linkage.rows)) if i not in found)


def dependencies(matrices: Sequence[Matrix]) -> dict[int, tuple[int, ...]]:
    """Each row that depends on earlier rows at every state -> all rows that it ever needs."""
    found = [elimination.dependencies(m) for m in matrices]
    if not found:
        return {}
    always = [i for i in found[0] if all(i in f for f in found)]
    return {i: tuple(sorted({k for f in found for k in f[i]})) for i in always}
