"""`--budget SECONDS`: a study from coarse to fine until its time is up, and what is left of it then."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from comparison.execution.deadline import Deadline
from comparison.execution.runner import Computed, Piece, Runner
from comparison.execution.task import Task
from comparison.execution.task_results import TaskResults
from comparison.registry import chosen_analyses, first_tasks, predicted_costs
from comparison.study.batches import Batch
from comparison.study.overhead import LOADING, START_UP, WRITING, slowness
from comparison.study.refinement import Step, first_steps, group_of, reached, steps
from comparison.study.study import Study
from reference.problem import SceneError

CHOSEN_LATER = 0.1  # of the budget: what the surfaces choose, such as motions, is left out if it would take more
SPARE = 1.0  # s: the system ends a task up to so much too late
DRAWN = "pictures"  # the analysis without which there is no report


@dataclass(frozen=True)
class Allotment:
    """
    How the time of a run is divided. surfaces: s for the steps, from the start of the workers. later: s for what the
    surfaces choose. writing: s for the report. dropped: analyses that have no time.
    """

    surfaces: float
    later: float
    writing: float
    dropped: tuple[str, ...]


@dataclass(frozen=True)
class Spent:
    """What a budget has bought. unfinished: steps that are not part of the study, with the s that they still take."""

    study: Study
    computed: Computed
    unfinished: Sequence[tuple[Step, float]]


def allotment(study: Study, budget: float, jobs: int) -> Allotment:
    """
    Divide a budget; what comes after the surfaces is predicted, and the rest is theirs.

    Parameters
    ----------
    study : Study
        The finest.
    budget : float
        s for the whole run.
    jobs : int
        Workers.

    Raises
    ------
    SceneError
        If not even the coarsest grids of both sides fit.
    """
    slow = slowness()
    later = [analysis for analysis in chosen_analyses(study) if analysis.needs_surfaces]
    seconds = {
        analysis.key: slow * sum(analysis.predicted_seconds(study.selecting(analysis.key))) / jobs for analysis in later
    }
    dropped = tuple(key for key, cost in seconds.items() if key != DRAWN and cost > CHOSEN_LATER * budget)
    kept = sum(cost for key, cost in seconds.items() if key not in dropped)
    writing = slow * WRITING + SPARE
    left = budget - slow * LOADING - kept - writing
    least = slow * (START_UP + sum(step.seconds for step in first_steps(study)) / jobs)
    if left < least:
        count = f"{len(study.scenes)} scenes" if len(study.scenes) > 1 else study.scenes[0].name
        rule = (
            f"the smallest study of {count} takes about {budget - left + least:.0f} s here with {jobs} "
            f"worker{'' if jobs == 1 else 's'}: give that, or fewer scenes"
        )
        raise SceneError("command line", "--budget", budget, rule)
    return Allotment(left, kept, writing, dropped)


def listed_steps(study: Study) -> list[Step]:
    """The steps of a budget in their order; those of analyses that do not need the surfaces among them."""
    analyses = [analysis for analysis in chosen_analyses(study) if not analysis.needs_surfaces]
    costs = predicted_costs(study, analyses)
    return steps(study, {analysis.key: costs[analysis.stage][1] for analysis in analyses})


def spend(runner: Runner, study: Study, budget: float, began: float) -> tuple[Spent, Runner]:
    """
    Compute as many steps as end in time.

    Parameters
    ----------
    runner : Runner
    study : Study
        The finest.
    budget : float
        s for the whole run.
    began : float
        `time.monotonic()` when the run began.

    Returns
    -------
    Spent, Runner
        What was reached, and the runner for what the surfaces choose, which has a deadline, too.

    Raises
    ------
    SceneError
        If the time was up before both sides had the values of their coarsest grid.
    """
    share = allotment(study, budget, runner.jobs)
    used = time.monotonic() - began
    deadline = Deadline(share.surfaces - used)
    listed, analyses = listed_steps(study), chosen_analyses(study)
    tasks_of = {analysis.key: first_tasks(study, [analysis]) for analysis in analyses if not analysis.needs_surfaces}
    tasks = [task for every in tasks_of.values() for task in every]
    step_of = _step_of(study, listed, {task.stage: key for key, every in tasks_of.items() for task in every})
    order = {step: number for number, step in enumerate(listed)}
    computed = replace(runner, deadline=deadline).run_study(study, tasks, lambda piece: order[step_of(piece)])
    unfinished = _unfinished(study, computed, tasks, step_of, runner.results, deadline)
    best = reached(study, [step for step in listed if step not in unfinished])
    if best is None:
        rule = "ended before both sides had a value; what was computed is kept: the same command goes on with it"
        raise SceneError("command line", "--budget", budget, rule)
    dropped = [*share.dropped, *(step.key for step in unfinished if not step.grid)]
    best = replace(best, selection=best.selection.without(dropped))
    asked = {_name(batch) for batch in best.batches()}
    pairs = [(batch, answer) for batch, answer in zip(computed.batches, computed.answers) if _name(batch) in asked]
    kept = Computed([batch for batch, _ in pairs], [answer for _, answer in pairs], computed.stored)
    has = {group_of(model): len(best.axis(model)) for model in best.hierarchy}
    left = [step for step in listed if step.grid > has.get(step.key, 0) or step in unfinished]
    spent = Spent(best, kept, [(step, unfinished.get(step, 0.0)) for step in left])
    return spent, replace(runner, deadline=Deadline(budget - LOADING - share.writing - (time.monotonic() - began)))


def drawings_first(piece: Piece) -> float:
    """The order in which the pictures are there before the time is up."""
    return 0.0 if isinstance(piece, Task) and piece.stage == DRAWN else 1.0


def _step_of(study: Study, listed: Sequence[Step], analysis_of: dict[str, str]) -> Callable[[Piece], Step]:
    """The step to which a batch or a task belongs."""
    group = {model.key: group_of(model) for model in study.hierarchy}
    levels: dict[str, list[Step]] = {}
    for step in listed:
        levels.setdefault(step.key, []).append(step)

    def step_of(piece: Piece) -> Step:
        if isinstance(piece, Task):
            return levels[analysis_of[piece.stage]][0]
        return levels[group[piece.model]][piece.level]

    return step_of


def _unfinished(
    study: Study,
    computed: Computed,
    tasks: Sequence[Task],
    step_of: Callable[[Piece], Step],
    results: TaskResults,
    deadline: Deadline,
) -> dict[Step, float]:
    """The steps of which something is missing, and the processor time that this takes, s."""
    done = {_name(batch) for batch in computed.batches}
    missing: list[Piece] = [batch for batch in study.batches() if _name(batch) not in done]
    missing += [task for task in tasks if task not in results]
    seconds: dict[Step, float] = {}
    for piece in missing:
        step = step_of(piece)
        seconds[step] = seconds.get(step, 0.0) + deadline.expected(piece.kind, piece.seconds)
    return seconds


def _name(batch: Batch) -> tuple[str, str, bytes]:
    """What tells a batch from the others of a study."""
    return batch.scene.name, batch.model, batch.phases.tobytes()
