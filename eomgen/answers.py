"""A state file and a study -> the numbers that `eomgen evaluate` prints."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from eomgen import evaluate, states
from eomgen.errors import UsageError
from eomgen.evaluate import Result
from eomgen.program import Program
from eomgen.states import State
from eomgen.study import Study


@dataclass(frozen=True)
class Question:
    """What computes, how many digits, and whether states are moved to the constraints."""

    using: str = "interpreter"
    digits: int = 17
    project: bool = False
    joints: bool = False  # the forces between components too, by the interpreter
    functions: Sequence[str] = ()  # these alone


def answers(study: Study, text: str, question: Question) -> list[Result]:
    """The results at every state of the JSON text.

    Raises:
        UsageError: the text is wrong, or `project` is asked for where nothing is linked.
        CheckError: something is singular, undefined or off the constraints at a state.
    """
    if question.joints and question.functions:
        raise UsageError("--joints adds to the usual results; --functions replaces them")
    if study.links is not None:
        return _linked(study, text, question)
    if question.project:
        raise UsageError("--project: the spec has no constraints to project a state on")
    source = _source(study, study.program, question)
    found = states.read(text, study.model, needs_time=evaluate.depends_on_time(source))
    using, digits = question.using, question.digits
    if question.functions:
        return evaluate.functions(study.model, source, found, using, digits)
    results = evaluate.evaluate(study.machine, source, found, using, digits)
    return _with_joints(study, study.program, found, results) if question.joints else results


def _source(study: Study, program: Program, question: Question) -> Program:
    """The program that answers: the functions that were asked for, or the whole of it."""
    if not question.functions:
        return program
    from eomgen.functions import table

    return table.select(program, study.machine, question.functions)


def _with_joints(
    study: Study, source: Program, states: Sequence[State], results: Sequence[Result]
) -> list[Result]:
    """The results with the reactions of the joints, in doubles."""
    from eomgen.evaluate_joints import joints

    pairs = zip(results, states, strict=True)
    return [
        {**result, "joints": joints(study.machine, source, study.model, (state, 17))}
        for result, state in pairs
    ]


def _linked(study: Study, text: str, question: Question) -> list[Result]:
    """The same for a scene with constraints: its program with multipliers answers."""
    from eomgen import evaluate_linked

    assert study.links is not None
    if question.joints and question.project:
        raise UsageError("--joints needs states that are admissible as they are, without --project")
    source = study.links.full_program()
    model = evaluate_linked.consistent(study.links)
    found = states.read(text, model, needs_time=evaluate.depends_on_time(source))
    how = (question.using, question.digits)
    if question.functions:
        wanted = _source(study, source, question)
        there = evaluate_linked.placed(study.links, source, found, project=question.project)
        return evaluate.functions(study.machine.model, wanted, there, *how)
    results = evaluate_linked.evaluate(study.links, source, found, how, project=question.project)
    return _with_joints(study, source, found, results) if question.joints else results
