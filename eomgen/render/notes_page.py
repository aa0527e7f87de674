"""What every part of the notes needs: the derivation, the words, the style, the arranger."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from eomgen.algebra.normal import Form
from eomgen.mechanics import lagrange
from eomgen.mechanics.equations import Derivation
from eomgen.render import arrange, tree, words
from eomgen.render.arrange import Arranger
from eomgen.render.style import Style
from eomgen.render.tree import Tree

LARGEST = 150  # terms of a formula that is written out
ENOUGH = 4 * LARGEST  # terms of a closed form that is not even arranged

How = Callable[[Arranger, Form], Tree]


@dataclass(frozen=True)
class Page:
    """One page of notes in the making."""

    derivation: Derivation
    language: str
    style: Style

    @cached_property
    def arranger(self) -> Arranger:
        """Arranges every formula of the page."""
        arranger = arrange.of_model(self.derivation.model)
        for row in self.derivation.constraints:
            arranger.order.rank(lagrange.multiplier_symbol(row.name))  # in this order
        return arranger

    @cached_property
    def words(self) -> Mapping[str, str]:
        """The words of the language."""
        return words.of(self.language)


def arranged(page: Page, how: How, form: Form) -> Tree | int:
    """The tree, or the number of its terms where they are too many to be read."""
    if len(form.terms) > ENOUGH:
        return len(form.terms)
    return readable(how(page.arranger, form))


def readable(found: Tree) -> Tree | int:
    """The tree, or its size where nobody would read it."""
    size = tree.size(found)
    return size if size > LARGEST else found


def spelled(page: Page, found: Tree | int) -> str:
    """The formula, or words that say how long it is."""
    if isinstance(found, int):
        return page.style.remark(page.words["long"].format(count=found))
    return page.style.formula(found)


def formula(page: Page, how: How, form: Form) -> str:
    """The closed form as finished text."""
    return spelled(page, arranged(page, how, form))


def joined(trees: Sequence[Tree]) -> Tree:
    """The sum of displayed sums, term after term."""
    return tree.total(tuple(term for t in trees for term in tree.terms_of(t)))
