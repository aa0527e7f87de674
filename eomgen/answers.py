"""A state file and a study -> the numbers that `eomgen evaluate` prints."""

from __future__ import annotations

from dataclasses import dataclass

from eomgen import evaluate, states
from eomgen.errors import UsageError
from eomgen.evaluate import Result
from eomgen.study import Study


@dataclass(frozen=True)
class Question:
    """What computes, how many digits, and whether states are moved to the constraints."""

    using: str = "interpreter"
    digits: int = 17
    project: bool = False


def answers(study: Study, text: str, question: Question) -> list[Result]:
    """The results at every state of the JSON text.

    Raises:
        UsageError: the text is wrong, or `project` is asked for where nothing is linked.
        CheckError: something is singular, undefined or off the constraints at a state.
    """
    if study.links is not None:
        return _linked(study, text, question)
    if question.project:
        raise UsageError("--project: the spec has no constraints to project a state on")
    needs_time = evaluate.depends_on_time(study.program)
    found = states.read(text, study.model, needs_time=needs_time)
    using, digits = question.using, question.digits
    return evaluate.evaluate(study.machine, study.program, found, using, digits)


def _linked(study: Study, text: str, question: Question) -> list[Result]:
    """The same for a scene with constraints: its program with multipliers answers."""
    from eomgen import evaluate_linked

    assert study.links is not None
    source = study.links.full_program()
    model = evaluate_linked.consistent(study.links)
    found = states.read(text, model, needs_time=evaluate.depends_on_time(source))
    how = (question.using, question.digits)
    return evaluate_linked.evaluate(study.links, source, found, how, project=question.project)
