"""The constraints on the page: a card for each, then what they leave free and why."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from fractions import Fraction

from eomgen.algebra.normal import Form
from eomgen.mechanics import speeds
from eomgen.mechanics.equations import multiplier_name, virtual_name
from eomgen.render import arrange, notes_data, tree
from eomgen.render.arrange import Arranger
from eomgen.render.notes_links import LinkCard, Links
from eomgen.render.notes_page import How, Page, arranged, formula, spelled
from eomgen.render.tree import Tree

REPEATED = 60  # terms of a rate form or a virtual form that is written out below its constraint

Row = Mapping[str, str]  # `label`: what kind of form; `body`: the equation


def tables(page: Page, links: Links | None) -> dict[str, object]:
    """Cards, degrees of freedom, and the sentence that calls the set free or linked."""
    if links is None or not links.cards:
        return {
            "set_said": _unlinked(page),
            "constraints": (),
            "constraints_said": (),
            "between_rates": False,
            "freedom": {},
        }
    return {
        "set_said": _set(page, links),
        "constraints": tuple(_card(page, c) for c in links.cards),
        "constraints_said": tuple(_constraints_said(page, links)),
        "between_rates": any(c.is_stated_in_rates for c in links.cards),
        "freedom": _freedom(page, links),
    }


def equations(page: Page) -> tuple[str, ...]:
    """The equation of every bilateral row, as it stands below the equations of motion."""
    rows = page.derivation.constraints
    forms = (row.rate if row.residual is None else row.residual for row in rows)
    return tuple(page.style.equation(formula(page, arrange.motion, f), "0") for f in forms)


def _unlinked(page: Page) -> str:
    """A scene without constraints has a free set; of others nothing is known here."""
    model = page.derivation.model
    if model.constraints:
        return ""
    count, freedom = len(model.coordinates), len(speeds.symbols(model))
    said = "coordinates_turns" if model.quaternions else "coordinates_free"
    return page.words[said].format(count=count, freedom=freedom)


def _set(page: Page, links: Links) -> str:
    """Free, linked, or independent and yet not free: n, g and the least number of coordinates."""
    count, freedom = links.coordinates, links.degrees_of_freedom
    if count == freedom:
        said = "coordinates_free"
    elif count == links.minimal_coordinates:
        said = "coordinates_independent"
    else:
        said = "coordinates_linked"
    return page.words[said].format(count=count, freedom=freedom)


# --- cards


def _card(page: Page, card: LinkCard) -> dict[str, object]:
    """Everything that is said of one constraint."""
    style = page.style
    return {
        "name": style.words(card.name),
        "text": style.words(card.text),
        "is_bilateral": card.is_bilateral,
        "is_rough": card.name in [c.name for c in page.derivation.model.guides],
        "answers": ", ".join(_answers(page, card)),
        "equations": tuple(_equations(page, card)),
        "virtual": tuple(_virtual(page, card)),
        "rates": tuple(_rates(page, card)),
        "hidden": tuple(
            _hidden(page, page.words["form_hidden"], f) for f in card.hidden if f is not None
        ),
        "remarks": tuple(_remarks(page, card)),
    }


def _answers(page: Page, card: LinkCard) -> Iterator[str]:
    """The three questions of the lecture, answered."""
    words = page.words
    yield words["bilateral" if card.is_bilateral else "unilateral"]
    yield words["scleronomic" if card.is_scleronomic else "rheonomic"]
    if not card.is_bilateral:
        yield words["inequality"]
    elif not card.is_holonomic:
        yield words["nonholonomic"].format(growth=", ".join(map(str, card.growth)))
    else:
        yield words["integrable" if card.is_stated_in_rates else "holonomic"]


def _equations(page: Page, card: LinkCard) -> Iterator[Row]:
    """Phi = 0, or the gap >= 0."""
    style = page.style
    label, relation = (
        ("form_equation", style.equation) if card.is_bilateral else ("form_gap", style.at_least)
    )
    for form in card.residuals:
        body = relation(formula(page, arrange.motion, form), "0")
        yield {"label": page.words[label], "body": body}


def _rates(page: Page, card: LinkCard) -> Iterator[Row]:
    """The rate form, where it is not the constraint itself."""
    forms = () if card.is_stated_in_rates else card.rates
    return _rows(page, _kind(card, "rate"), arrange.motion, forms)


def _virtual(page: Page, card: LinkCard) -> Iterator[Row]:
    """The sum of (d phi/d q_j) delta q_j."""
    return _rows(page, _kind(card, "virtual"), arrange.work, card.virtual)


def _kind(card: LinkCard, form: str) -> str:
    """The word for a form; a gap's rate and variation vanish in contact only."""
    return f"form_{form}" if card.is_bilateral else f"form_{form}_contact"


def _rows(page: Page, label: str, how: How, forms: Iterable[Form]) -> Iterator[Row]:
    """Each form = 0 with its label; a long one only repeats a constraint that is long itself."""
    for form in forms:
        found = arranged(page, how, form)
        size = found if isinstance(found, int) else tree.size(found)
        shown = spelled(page, size if size > REPEATED else found)
        yield {"label": page.words[label], "body": page.style.equation(shown, "0")}


def _hidden(page: Page, label: str, relation: Form) -> Row:
    """The relation between positions that was found: a constant of every motion."""
    constant = page.style.remark(page.words["constant"])
    body = page.style.equation(formula(page, arrange.motion, relation), constant)
    return {"label": label, "body": body}


def _remarks(page: Page, card: LinkCard) -> Iterator[str]:
    """Multipliers, rows that say nothing new, contact and flight, what was not found."""
    words = page.words
    if card.is_bilateral:
        said = words["multiplier" if len(card.rows) == 1 else "multipliers"]
        yield said.format(symbols=_symbols(page, map(multiplier_name, card.rows)))
        yield from _given(page, card)
    elif card.rows:
        yield words["contact"]
        yield from _given(page, card)
    if card.is_stated_in_rates and card.is_holonomic and None in card.hidden:
        yield words["hidden_unknown"]
    if card.redundant:
        yield words["redundant"].format(rows=page.style.words(", ".join(card.redundant)))


def _given(page: Page, card: LinkCard) -> Iterator[str]:
    """What the spec says of impact and of friction."""
    stated = next((c for c in page.derivation.model.constraints if c.name == card.name), None)
    for word in ("restitution", "friction"):
        value = getattr(stated, word, None)
        if value is not None:
            yield page.words[word].format(value=page.style.inline(notes_data.closed(page, value)))


def _symbols(page: Page, names: Iterable[str]) -> str:
    return ", ".join(page.style.inline(page.style.symbol(n)) for n in names)


def _constraints_said(page: Page, links: Links) -> Iterator[str]:
    """What the numbers behind a constraint that cannot be integrated are."""
    if any(card.growth for card in links.cards):
        yield page.words["growth"]
        if links.is_time_counted:
            yield page.words["growth_time"]


# --- degrees of freedom


def _freedom(page: Page, links: Links) -> dict[str, object]:
    """Both numbers, how they are known, and a basis of the virtual displacements."""
    return {
        "counts": tuple(_counts(page, links)),
        "said": tuple(_said(page, links)),
        "combined": tuple(
            _hidden(page, page.style.words(", ".join(c.rows)), c.relation) for c in links.combined
        ),
        "basis_said": _basis_said(page, links),
        "basis": _basis(page, links),
        "warnings": tuple(page.style.words(w) for w in links.warnings),
        "sentences": tuple(page.style.words(s) for s in links.sentences),
    }


def _counts(page: Page, links: Links) -> Iterator[Row]:
    """Rows of the count; the least number of coordinates where it is another number."""
    count, rank, freedom = links.coordinates, links.rank, links.degrees_of_freedom
    difference = tree.Sum((tree.Number(Fraction(count)), tree.Number(Fraction(-rank))))
    proof = f"{page.style.formula(difference)} = {freedom}" if rank else str(freedom)
    yield {"label": page.words["count_coordinates"], "body": str(count)}
    yield {"label": page.words["count_rank"], "body": str(rank)}
    yield {"label": page.words["count_freedom"], "body": page.style.inline(proof)}
    if links.minimal_coordinates != freedom:
        label = page.words["count_minimal"]
        yield {"label": label, "body": str(links.minimal_coordinates)}


def _said(page: Page, links: Links) -> Iterator[str]:
    """The proof of the rank, then what the two numbers mean."""
    words = page.words
    if any(card.is_bilateral for card in links.cards):
        yield words["proof"].format(states=links.states)
        freedom, minimal = links.degrees_of_freedom, links.minimal_coordinates
        said = "all_holonomic" if freedom == minimal else "some_nonholonomic"
        yield words[said].format(freedom=freedom, minimal=minimal)
    if not all(card.is_bilateral for card in links.cards):
        yield words["count_contact"]


def _basis_said(page: Page, links: Links) -> str:
    if not links.independent:
        return page.words["no_basis"]
    said = "basis_others" if links.displacements else "basis"
    return page.words[said].format(symbols=_symbols(page, map(virtual_name, links.independent)))


def _basis(page: Page, links: Links) -> str:
    """The virtual displacements that follow from those of the basis."""
    found: Sequence[tuple[str, Form]] = links.displacements or ()
    rows = [(page.style.symbol(virtual_name(n)), formula(page, displaced, f)) for n, f in found]
    return page.style.display(rows) if rows else ""


def displaced(arranger: Arranger, form: Form) -> Tree:
    """A virtual displacement over others, quotients of equal sums cancelled."""
    terms = tree.terms_of(arrange.work(arranger, form))
    return tree.total(tuple(cancelled(t) for t in terms))


def cancelled(term: Tree) -> Tree:
    """The term without the factors that stand on both sides of its fraction, or do but for sign."""
    if not isinstance(term, tree.Product):
        return term
    number, above, below = term.coefficient, list(term.factors), list(term.divisors)
    for divisor in term.divisors:
        for sign, same in ((1, divisor), (-1, _opposite(divisor))):
            if same in above and divisor in below:
                above.remove(same)
                below.remove(divisor)
                number *= sign
    return tree.product(number, tuple(above), tuple(below))


def _opposite(found: Tree) -> Tree:
    """A difference the other way round: b - a for a - b."""
    terms = tree.terms_of(tree.negated(found))
    return tree.total(tuple(sorted(terms, key=lambda t: tree.split_sign(t)[0])))
