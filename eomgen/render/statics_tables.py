"""The equilibria in tables: positions with their stability, loads, reactions, each in columns."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from decimal import Decimal
from math import degrees

from eomgen.dimension import NONE
from eomgen.mechanics.equations import multiplier_name
from eomgen.model import AXES, Coordinate
from eomgen.render import latex_width, notes_data, statics_words, text_style
from eomgen.render.notes_page import Page

MOST_ROWS = 30  # of one table, so that it fits on a page
DEGREE = "\u00b0"


@dataclass(frozen=True)
class Rest:
    """One equilibrium; values in SI."""

    coordinates: Mapping[str, Decimal]
    verdict: str  # stable, unstable, undecided
    reason: str
    multipliers: Mapping[str, Decimal] = field(default_factory=dict)  # by the name of the row
    reactions: Mapping[str, tuple[Decimal, ...]] = field(default_factory=dict)
    contacts: tuple[str, ...] = ()  # unilateral constraints that touch
    is_isolated: bool = True
    are_loads_unique: bool = True


@dataclass(frozen=True)
class Column:
    """A head and one cell for each equilibrium; `align` is l or r."""

    head: str
    cells: tuple[str, ...]
    align: str = "r"


@dataclass(frozen=True)
class Layout:
    """How columns become a table that fits the line."""

    line: float
    gap: float  # between two columns
    width: Callable[[str], float]
    is_padded: bool  # cells are filled up with blanks
    digits: int = 10


def _latex_width(cell: str) -> float:
    """The width in figures; a sign is narrower than a minus between two terms."""
    bare = cell.replace("$", "")
    return latex_width.width(bare.removeprefix("-")) + SIGN * bare.startswith("-")


SIGN = 1.6
LATEX = Layout(line=84.0, gap=2.2, width=_latex_width, is_padded=False, digits=7)
TEXT = Layout(line=text_style.LINE, gap=2.0, width=text_style.width, is_padded=True)


def tables(
    page: Page, found: Sequence[Rest], layout: Layout, arbitrary: Sequence[str]
) -> tuple[dict[str, object], ...]:
    """Positions and verdicts, then multipliers, then reactions; wide or long ones in parts."""
    groups = (
        [*_positions(page, found, layout, arbitrary), *_verdicts(page, found)],
        [*_multipliers(page, found, layout), *_reactions(page, found, layout)],
    )
    number = Column(statics_words.of(page.language)["number"], _numbers(page, found))
    return tuple(
        _table([_cut(c, start) for c in (number, *part)], layout)
        for columns in groups
        for part in _parts(number, columns, layout)
        for start in range(0, len(found), MOST_ROWS)
    )


def _numbers(page: Page, found: Sequence[Rest]) -> tuple[str, ...]:
    return tuple(page.style.inline(str(i)) for i, _ in enumerate(found, 1))


def _positions(
    page: Page, found: Sequence[Rest], layout: Layout, arbitrary: Sequence[str]
) -> Iterator[Column]:
    """A column for each coordinate; an angle has one in degrees too."""
    for c in page.derivation.model.coordinates:
        values = [e.coordinates[c.name] for e in found]
        if c.name in arbitrary:
            said = statics_words.of(page.language)["any"]
            yield Column(_head(page, c.symbol.name, ""), tuple(said for _ in found), "l")
            continue
        yield _column(page, _head(page, c.symbol.name, _unit(c)), values, layout.digits)
        if c.description.dimension == NONE:
            turned = [degrees(float(v)) for v in values]
            yield _column(page, _head(page, c.symbol.name, DEGREE), turned, layout.digits - 1)


def _unit(coordinate: Coordinate) -> str:
    """The unit of the values, which are SI."""
    is_angle = coordinate.description.dimension == NONE
    return "rad" if is_angle else notes_data.si_unit(coordinate.description)


def _verdicts(page: Page, found: Sequence[Rest]) -> Iterator[Column]:
    """What touches, if anything does anywhere, and the stability."""
    said = statics_words.of(page.language)
    if any(e.contacts for e in found):
        cells = tuple(page.style.words(", ".join(e.contacts)) for e in found)
        yield Column(said["touching"], cells, "l")
    yield Column(said["stability"], tuple(said[e.verdict] for e in found), "l")


def _multipliers(page: Page, found: Sequence[Rest], layout: Layout) -> Iterator[Column]:
    for name in _names(e.multipliers for e in found):
        head = page.style.inline(page.style.symbol(multiplier_name(name)))
        yield _column(page, head, [e.multipliers.get(name) for e in found], layout.digits)


def _reactions(page: Page, found: Sequence[Rest], layout: Layout) -> Iterator[Column]:
    """A column for each component, in world axes."""
    for name in _names(e.reactions for e in found):
        forces = [e.reactions.get(name) for e in found]
        size = max(len(f) for f in forces if f is not None)
        for i, axis in enumerate(AXES[:size]):
            head = page.style.inline(page.style.index("F", name, axis)) + _in(page, _force(page))
            values = [None if f is None else f[i] for f in forces]
            yield _column(page, head, values, layout.digits)


def _force(page: Page) -> str:
    return "N" if page.derivation.model.with_units else ""


def _names(held: Iterable[Mapping[str, object]]) -> tuple[str, ...]:
    """The names of all, each once, as first seen."""
    return tuple(dict.fromkeys(name for one in held for name in one))


def _head(page: Page, symbol: str, unit: str) -> str:
    return page.style.inline(page.style.symbol(symbol)) + _in(page, unit)


def _in(page: Page, unit: str) -> str:
    return f" [{page.style.inline(page.style.unit(unit))}]" if unit else ""


def _column(page: Page, head: str, values: Sequence[Decimal | float | None], digits: int) -> Column:
    """Rounded values; empty where there is none."""
    cells = ("" if v is None else f"{float(v):.{digits}g}" for v in values)
    return Column(head, tuple(page.style.inline(page.style.number(c)) if c else "" for c in cells))


def _cut(column: Column, start: int) -> Column:
    return replace(column, cells=column.cells[start : start + MOST_ROWS])


def _wide(column: Column, layout: Layout) -> float:
    return max(layout.width(cell) for cell in (column.head, *column.cells))


def _parts(number: Column, columns: Sequence[Column], layout: Layout) -> Iterator[list[Column]]:
    """The columns in parts that fit the line, beside their numbers."""
    part: list[Column] = []
    start = filled = _wide(number, layout)
    for column in columns if number.cells else ():
        wide = layout.gap + _wide(column, layout)
        if part and filled + wide > layout.line:
            yield part
            part, filled = [], start
        part.append(column)
        filled += wide
    if part:
        yield part


def _table(columns: Sequence[Column], layout: Layout) -> dict[str, object]:
    """Heads and rows, for text in columns of their width."""
    shown = [_padded(c, layout) if layout.is_padded else c for c in columns]
    return {
        "align": "".join(c.align for c in columns),
        "heads": tuple(c.head for c in shown),
        "rows": tuple(zip(*(c.cells for c in shown), strict=True)),
    }


def _padded(column: Column, layout: Layout) -> Column:
    """Every cell as wide as the widest."""
    wide = _wide(column, layout)

    def filled(cell: str) -> str:
        blanks = " " * round(wide - layout.width(cell))
        return blanks + cell if column.align == "r" else cell + blanks

    return Column(filled(column.head), tuple(map(filled, column.cells)), column.align)


def reasons(page: Page, found: Sequence[Rest]) -> tuple[dict[str, str], ...]:
    """Why an equilibrium is called what it is; those of one reason together."""
    said = statics_words.of(page.language)
    held: dict[tuple[str, str], list[int]] = {}
    for i, e in enumerate(found, 1):
        alone = "" if e.is_isolated else f"; {said['not_isolated']}"
        reason = statics_words.translated(e.reason, page.language) + alone
        held.setdefault((said[e.verdict], reason), []).append(i)
    return tuple(
        {
            "numbers": ", ".join(map(str, numbers)),
            "verdict": verdict,
            "reason": page.style.words(reason),
        }
        for (verdict, reason), numbers in held.items()
    )


def loads_said(page: Page, found: Sequence[Rest]) -> Iterator[str]:
    """What the columns of the loads mean, and where they are not determined."""
    said = statics_words.of(page.language)
    if any(e.multipliers for e in found) and page.derivation.model.with_units:
        yield said["multipliers_si"]
    if any(e.reactions for e in found):
        yield said["reactions"].format(force=page.style.inline("F"))
    loose = [str(i) for i, e in enumerate(found, 1) if not e.are_loads_unique]
    if loose:
        yield said["not_unique"].format(numbers=", ".join(loose))
