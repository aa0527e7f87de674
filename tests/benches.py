"""Scenes at many states at once (NumPy), or at single states in any arithmetic."""

from collections.abc import Iterator
from dataclasses import replace

from eomgen.algebra.arithmetic import NUMPY, Arithmetic
from eomgen.checks.evaluation import Bench, leaves_of
from eomgen.checks.samples import Samples
from eomgen.compile import Machine


def bench(machine: Machine, samples: Samples, arithmetic: Arithmetic = NUMPY) -> Bench:
    """The scene at the samples: one value for each component, an array over all of them."""
    arguments = samples.arguments()
    leaves = {
        leaf: arithmetic.number(arguments[leaf.datum.argument][leaf.datum.index])
        for leaf in leaves_of(machine)
    }
    return Bench(machine, leaves, arithmetic)


def singly(samples: Samples, count: int) -> Iterator[Samples]:
    """The first samples one by one, as scalars."""
    for i in range(min(count, samples.count)):
        yield replace(
            samples,
            count=1,
            time=samples.time[i],
            state=[column[i] for column in samples.state],
            inputs=[column[i] for column in samples.inputs],
            parameters=[column[i] for column in samples.parameters],
            accelerations=[[a[i]] for a in samples.accelerations],
        )
