"""A scene in each of its formulations and precisions, compiled with all its integrators."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from eomgen import compile_steps, formulation, stepping
from eomgen.chart.records import PRECISIONS
from eomgen.errors import UsageError
from eomgen.integrators.methods import METHODS, Method
from eomgen.numerics.engine_c import EngineC
from eomgen.numerics.records import Array, Engine
from eomgen.simulate_setup import Setup, setup, start_of, touching_of
from eomgen.study import Study
from eomgen.wanted import Wanted

ALONE = "minimal"  # of a scene without constraints: its coordinates are free


@dataclass(frozen=True)
class Variant:
    """A formulation with its methods, and an engine for each precision."""

    name: str
    setup: Setup
    methods: tuple[Method, ...]
    engines: dict[str, Engine]

    @property
    def projects(self) -> bool:
        """Whether a step ends with a projection."""
        return self.setup.steps.projects_positions or self.setup.steps.has("project_rates")

    def places(self, times: Array, states: Array, precision: str = "f64") -> tuple[Array, Array]:
        """All coordinates of the spec and their rates, (N, n) each, in double."""
        engine, steps = self.engines[precision], self.setup.steps
        if steps.has("all_coordinates"):
            return (
                engine.sweep("all_coordinates", times, states),
                engine.sweep("all_rates", times, states),
            )
        count = len(steps.program.coordinates)
        slopes = engine.sweep("state_derivative", times, states)
        return states[:, :count], slopes[:, :count]

    def outputs(self, times: Array, states: Array, precision: str = "f64") -> Array:
        """The outputs of the spec (N, k), in double."""
        return self.engines[precision].sweep("outputs", times, states)


def of(
    study: Study, state: str, inputs: dict[str, str], names: Sequence[str]
) -> tuple[Variant, ...]:
    """The variants of a study, `names` of its formulations or all.

    Raises:
        UsageError: the scene has contacts, or not that formulation.
    """
    if touching_of(study) is not None:
        raise UsageError(
            "a scene with contacts has no chart: fixed steps do not locate its events; "
            "eomgen simulate runs it"
        )
    known = (ALONE,) if study.links is None else study.links.formulations
    for name in names:
        if name not in known:
            raise UsageError(f"this scene has no formulation {name!r}; it has {', '.join(known)}")
    return tuple(
        _variant(name, _formulated(study, name), state, inputs)
        for name in known
        if not names or name in names
    )


def _formulated(study: Study, name: str) -> Study:
    """The study in one of its formulations."""
    if study.links is None:
        return study
    links = replace(study.links, chosen=formulation.choose(study.links.scene, Wanted(name)))
    return replace(study, program=links.program(), links=links)


def _variant(name: str, study: Study, state: str, inputs: dict[str, str]) -> Variant:
    scene = stepping.scene_of(study)
    methods = tuple(m for m in METHODS.values() if compile_steps.offers(scene, m))
    made = setup(study, tuple(m.name for m in methods), start_of(study, state, inputs))
    return Variant(name, made, methods, {"f64": made.engine})


def in_precision(variant: Variant, precision: str) -> Variant:
    """The variant with an engine of that precision too.

    Raises:
        UsageError: there is no C compiler.
    """
    if precision in variant.engines:
        return variant
    engine = EngineC(variant.setup.steps, variant.setup.start.given, PRECISIONS[precision])
    return replace(variant, engines={**variant.engines, precision: engine})
