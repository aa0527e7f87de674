"""Contacts on the page: gap, flight, contact, impact, stick and slip."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from eomgen.algebra.normal import Form
from eomgen.mechanics.contact_forms import ContactForms, Rub
from eomgen.mechanics.equations import Derivation, multiplier_name, reaction_name
from eomgen.render import arrange, latex_names, notes_equation, notes_steps, tree
from eomgen.render.notes_page import Page, formula, spelled
from eomgen.render.notes_reactions import LONGEST
from eomgen.render.tree import Symbol, Tree


def aliases(derivation: Derivation, contacts: Sequence[ContactForms]) -> dict[str, str]:
    """How the symbols of contacts are called: lambda, P and F_t, with the name if there are more.

    A multiplier of the scene keeps its own name.
    """
    taken = [*latex_names.table(derivation.model).values()]
    taken += [latex_names.spelled("lambda")] if derivation.constraints else []
    return notes_steps.free_names(_proposals(contacts), taken)


def _proposals(contacts: Sequence[ContactForms]) -> Iterator[tuple[str, str]]:
    for contact in contacts:
        name = f"_{contact.name}" if len(contacts) > 1 else ""
        yield multiplier_name(contact.name), f"lambda{name}"
        yield reaction_name("P", contact.name), f"P{name}"
        yield reaction_name("N", contact.name), f"N{name}"
        yield reaction_name("T", contact.name), f"F_t{name}"
        yield _slip_name(contact.name), f"v_t{name}"
        yield _gap_name(contact.name), f"h{name}"


def _slip_name(contact: str) -> str:
    """The name of the symbol of the slip velocity."""
    return f"slip {contact}"


def _gap_name(contact: str) -> str:
    """The name of the symbol of the gap."""
    return f"gap {contact}"


def contact(page: Page, found: ContactForms) -> dict[str, object]:
    """Everything that is shown of one contact."""
    words, style = page.words, page.style
    multiplier = style.inline(style.symbol(found.multiplier.name))
    vanishing = style.inline(f"{style.symbol(found.multiplier.name)} = 0")
    impulse = style.inline(style.symbol(reaction_name("P", found.name)))
    return {
        "name": style.words(found.name),
        "gap": style.display(_gap(page, found)),
        "flight_said": words["contact_flight"].format(force=vanishing),
        "closed_said": words["contact_closed"].format(force=multiplier),
        "closed": tuple(notes_equation.shown(page, e)["body"] for e in found.equations),
        "second": style.equation(formula(page, arrange.motion, found.second), "0"),
        "force_said": words["contact_normal" if found.force is None else "contact_force"],
        "force": style.display(list(_forces(page, found))),
        "ends_said": words["contact_ends"].format(force=multiplier),
        "impact_said": words["contact_impact"].format(impulse=impulse),
        "impact": tuple(_jumps(page, found)),
        **_restitution(page, found),
        "friction": {} if found.rub is None else _friction(page, found, found.rub),
    }


def _gap(page: Page, found: ContactForms) -> list[tuple[str, str]]:
    name = page.style.symbol(_gap_name(found.name))
    return [
        (name, formula(page, arrange.motion, found.gap)),
        (page.style.dotted(name), formula(page, arrange.motion, found.rate)),
    ]


def _forces(page: Page, found: ContactForms) -> Iterator[tuple[str, str]]:
    """lambda_N over the state, where it is short, and N in newtons."""
    if found.force is not None:
        yield page.style.symbol(found.multiplier.name), _short(page, found.force)
    if found.normal is not None:
        yield page.style.symbol(reaction_name("N", found.name)), _acting(page, found.normal)


def _short(page: Page, form: Form) -> str:
    found = notes_steps.reduced(page, arrange.loads, form)
    size = found if isinstance(found, int) else tree.size(found)
    return spelled(page, size if size > LONGEST else found)


def _acting(page: Page, form: Form) -> str:
    return spelled(page, notes_steps.acting(page, form * 0, form))


def _jumps(page: Page, found: ContactForms) -> Iterator[str]:
    """M dq' = G' P, row by row."""
    for jump, impulse in zip(found.jumps, found.impulses, strict=True):
        yield page.style.equation(formula(page, arrange.work, jump), _acting(page, impulse))


def _restitution(page: Page, found: ContactForms) -> dict[str, str]:
    """The law of the impact; nothing where the spec does not say it."""
    if found.restitution is None:
        return {"restitution_said": "", "restitution": ""}
    style = page.style
    shown = notes_steps.moved(page, found.restitution)
    factor = shown if not isinstance(shown, int) else Symbol("e")
    rate = style.dotted(style.symbol(_gap_name(found.name)))
    value = style.inline(style.formula(factor))
    before = _against(page, factor, rate)
    return {
        "restitution_said": page.words["contact_restitution"].format(value=value),
        "restitution": style.display([(style.after(rate), before)]),
    }


def _against(page: Page, factor: Tree, rate: str) -> str:
    """-e times the rate before."""
    if factor == tree.ZERO:
        return "0"
    spelled_out = page.style.formula(tree.negated(factor))
    shown = f"({spelled_out})" if isinstance(factor, tree.Sum) else spelled_out
    return f"{shown} {page.style.before(rate)}"


def _friction(page: Page, found: ContactForms, rub: Rub) -> dict[str, object]:
    """Stick and slip."""
    style = page.style
    slip, force = style.symbol(_slip_name(found.name)), style.symbol(rub.tangential.name)
    pressed = style.symbol(reaction_name("N", found.name))
    limit = f"{formula(page, arrange.motion, rub.coefficient)} {pressed}"
    solid = rub.slip is None
    said = page.words["contact_friction_solid" if solid else "contact_friction"]
    direction = style.fraction(slip, style.size(slip)) if solid else style.sign(slip)
    minus = style.formula(tree.negated(tree.ONE))[0]
    rows = [] if rub.slip is None else [(slip, formula(page, arrange.motion, rub.slip))]
    return {
        "said": said.format(
            point=style.words(rub.point), slip=style.inline(slip), force=style.inline(force)
        ),
        "slip_velocity": style.display(rows) if rows else "",
        "equations": ()
        if solid
        else tuple(notes_equation.shown(page, e)["body"] for e in rub.equations),
        "stick": (style.equation(slip, "0"), style.at_least(limit, style.size(force))),
        "slip": (style.equation(force, f"{minus}{limit} {direction}"),),
    }
