"""The way in: the text of a spec file -> a frozen `Model`, or every fault of the file."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from eomgen.model import Model


def read(text: str | bytes, file: str) -> Model:
    """The model of a spec; raises `SpecError` with every fault of the file."""
    # imported here: the schema and the report answer without SymPy
    from eomgen.spec import document

    return document.read(text, file)
