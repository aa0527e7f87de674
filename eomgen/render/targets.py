"""The table of targets: one row a language, one template a file."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Protocol

import jinja2

from eomgen.render import code_context, notes, statics, steps_context
from eomgen.render.names import module
from eomgen.render.templating import fill


class Named(Protocol):
    """What is rendered: a program, or a record that a target's `context` understands."""

    @property
    def name(self) -> str:
        """The stem of the files."""


@dataclass(frozen=True)
class Target:
    """A kind of document: file name -> template, and the names that its templates see.

    In a file name `{name}` is the subject's name and `{module}` the identifier made of it.
    `context` returns text, numbers and records of these, nothing that a template could misuse.
    """

    about: str
    files: Mapping[str, str]
    context: Callable[[Any], dict[str, object]]


FORMALISMS = {
    "newton": "Newton's and Euler's laws",
    "dalembert": "d'Alembert's principle",
    "lagrange1": "Lagrange's first kind in Cartesian coordinates",
    "kane": "Kane's method",
}
TARGETS = {
    "latex": Target(
        "lecture notes: pdflatex with amsmath",
        {"{name}.tex": "latex/notes.tex.j2"},
        notes.latex_context,
    ),
    "c": Target(
        "C99 header and source",
        {"{name}.h": "c/model.h.j2", "{name}.c": "c/model.c.j2"},
        code_context.c,
    ),
    "c-steps": Target(
        "C99 header and source of integrators, beside those of the equations",
        {"{name}_steps.h": "c/steps.h.j2", "{name}_steps.c": "c/steps.c.j2"},
        steps_context.c,
    ),
    "c-driver": Target(
        "C source that runs the steps for `simulate`",
        {"{name}_driver.c": "c/driver.c.j2"},
        steps_context.c,
    ),
    "python": Target(
        "Python module that needs NumPy only",
        {"{module}.py": "python/model.py.j2"},
        code_context.python,
    ),
    "text": Target(
        "Unicode text for the terminal",
        {"{name}.txt": "text/derivation.txt.j2"},
        notes.text_context,
    ),
    **{
        f"latex-{method}": Target(
            f"lecture notes by {said}: pdflatex with amsmath",
            {"{name}.tex": f"latex/{method}.tex.j2"},
            notes.latex_context,
        )
        for method, said in FORMALISMS.items()
    },
    **{
        f"text-{method}": Target(
            f"Unicode text by {said} for the terminal",
            {"{name}.txt": f"text/{method}.txt.j2"},
            notes.text_context,
        )
        for method, said in FORMALISMS.items()
    },
    "statics-latex": Target(
        "lecture notes on equilibrium: pdflatex with amsmath",
        {"{name}_statics.tex": "latex/statics.tex.j2"},
        statics.latex_context,
    ),
    "statics-text": Target(
        "Unicode text on equilibrium for the terminal",
        {"{name}_statics.txt": "text/statics.txt.j2"},
        statics.text_context,
    ),
}


def render(subject: Named, target: Target, templates: jinja2.Environment) -> dict[str, str]:
    """File name -> text. Pure: writing files is the command line's work."""
    context = target.context(subject)
    names = {"name": subject.name, "module": module(subject.name)}
    return {
        file.format(**names): fill(templates, template, context)
        for file, template in target.files.items()
    }
