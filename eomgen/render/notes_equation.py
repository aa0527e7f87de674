"""One equation of motion on the page."""

from __future__ import annotations

from eomgen.mechanics.equations import Equation
from eomgen.render import arrange_equation, tree
from eomgen.render.arrange_equation import RIGHT
from eomgen.render.notes_page import ENOUGH, Page, readable, spelled

PARTS = ("inertia", "damping", "elastic", "gravity", "other", *RIGHT)


def shown(page: Page, row: Equation) -> dict[str, str]:
    """One equation, and the words before it: what it was divided by."""
    style = page.style
    count = sum(len(form.terms) for part in PARTS if (form := getattr(row, part)))
    if count > ENOUGH:
        return {"body": style.equation(spelled(page, count), "0"), "said": page.words["equation"]}
    found = arrange_equation.equation(page.arranger, row)
    left, right = (spelled(page, readable(side)) for side in (found.left, found.right))
    divisor = "" if found.divisor == tree.ONE else style.inline(style.formula(found.divisor))
    said = page.words["divided"].format(divisor=divisor) if divisor else page.words["equation"]
    return {"body": style.equation(left, right), "said": said}
