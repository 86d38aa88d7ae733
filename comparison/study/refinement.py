"""
A study from coarse to fine: the steps that a budget of time is spent on, and the study that the finished ones make.

A step gives the equations, or one model of the engine, the next of their nested grids (nesting.py), or it is an
analysis beside the surfaces. The cheapest step that is possible comes next. No step needs another one's results, so
that predicted costs decide only the order.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace

from comparison.study.models import Model
from comparison.study.nesting import nested_grids
from comparison.study.study import Study

EQUATIONS = "equations"  # all models of the reference together
FINEST = {EQUATIONS: 96, "translational": 48, "spatial": 24}  # phases per axis: no budget buys more


@dataclass(frozen=True)
class Step:
    """`key`: EQUATIONS, the key of an engine's model, or that of an analysis."""

    key: str
    grid: int  # phases per axis that the step completes; 0 for an analysis
    seconds: float  # predicted processor time of what it adds


def group_of(model: Model) -> str:
    """The key of the steps that compute a model."""
    return EQUATIONS if model.side == "reference" else model.key


def grids(study: Study) -> dict[str, tuple[int, ...]]:
    """The nested grids of every group of models, in the order of the hierarchy."""
    return {group_of(model): nested_grids(len(study.axis(model))) for model in study.hierarchy}


def refinements(study: Study) -> dict[str, list[Step]]:
    """The steps of every group of models, from coarse to fine."""
    seconds: dict[tuple[str, int], float] = defaultdict(float)
    group = {model.key: group_of(model) for model in study.hierarchy}
    for batch in study.batches():
        seconds[group[batch.model], batch.level] += batch.seconds
    return {
        key: [Step(key, grid, seconds[key, level]) for level, grid in enumerate(chain)]
        for key, chain in grids(study).items()
    }


def first_steps(study: Study) -> list[Step]:
    """What every study has: the coarsest grid of the equations and of the first model of the engine."""
    return [chain[0] for chain in list(refinements(study).values())[:2]]


def steps(study: Study, analyses: Mapping[str, float]) -> list[Step]:
    """
    All steps to a study, in the order in which they are computed.

    Parameters
    ----------
    study : Study
        The finest.
    analyses : mapping of str to float
        Predicted processor time of the analyses beside the surfaces, s, by key.

    Returns
    -------
    list of Step
        First those of `first_steps`, then the cheapest one that is left. No model has a finer grid than the one before.
    """
    chains = refinements(study)
    ordered = [chain.pop(0) for chain in list(chains.values())[:2]]
    left = [Step(key, 0, seconds) for key, seconds in analyses.items()]
    finest = {step.key: step.grid for step in ordered}
    before = dict(zip(list(chains)[1:], chains))  # the group before each, whose grid is at least as fine
    while True:
        possible = [
            chain[0]
            for key, chain in chains.items()
            if chain and (key not in before or chain[0].grid <= finest.get(before[key], 0))
        ]
        if not (possible or left):
            return ordered
        step = min([*possible, *left], key=lambda step: step.seconds)
        ordered.append(step)
        if step.grid:
            finest[step.key] = chains[step.key].pop(0).grid
        else:
            left.remove(step)


def reached(study: Study, finished: Collection[Step]) -> Study | None:
    """
    The best complete study of the finished steps.

    Parameters
    ----------
    study : Study
        The finest.
    finished : collection of Step

    Returns
    -------
    Study or None
        None unless both sides have a grid.
    """
    done = {(step.key, step.grid) for step in finished}
    finest: dict[str, int] = {}
    most = study.grid
    for key, chain in grids(study).items():
        complete = 0
        for grid in chain:
            if (key, grid) not in done:
                break
            complete = grid if grid <= most else complete
        finest[key] = most = complete
    if not all(list(finest.values())[:2]):
        return None
    hierarchy = [replace(model, most=finest[group_of(model)]) for model in study.hierarchy if finest[group_of(model)]]
    return replace(study, grid=max(finest.values()), hierarchy=hierarchy)
