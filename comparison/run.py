"""
The study on the command line: `python -m comparison.run [SCENE ...]`.

Exit codes: 0 done; 1 a limit of --check is broken; 2 a wrong scene or option, before anything is computed; 3 something
could not be written, or an unexpected error; 4 the cluster was lost; 128 + number of the signal, 130 for Ctrl-C; 141
whoever read the output closed it. After 3, 4 and a signal the same command goes on where it stopped.
"""

from __future__ import annotations

if __name__ == "__main__":
    from comparison.cli.start import start

    start("comparison.run")  # does not return: the module is loaded once, under its own name

import sys
import time
from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from dataclasses import replace
from datetime import UTC, datetime
from importlib import import_module
from pathlib import Path
from typing import Any

from rich.console import Console

from comparison.analysis.surfaces import labeled_surfaces
from comparison.analysis.taken_up import TAKEN_UP
from comparison.analysis.targets import targets_met
from comparison.analysis.unanswered import with_silent_models
from comparison.cli.arguments import command, writing
from comparison.cli.budgeted import allotment, drawings_first, spend
from comparison.cli.closing import print_check, print_closing, print_faults
from comparison.cli.computing import ending_early
from comparison.cli.entered import Engines, as_words
from comparison.cli.options import Options, parsed
from comparison.cli.start import Clock, start_time
from comparison.cli.terminal import print_models_left_out, print_plan, print_tolerance
from comparison.execution.cache import Cache, store_beside
from comparison.execution.executors import Pool
from comparison.execution.keys import batch_key, task_key
from comparison.execution.output import atomic_replace, clear_dead, on_stderr
from comparison.execution.processes import process_pool
from comparison.execution.progress import wide_console
from comparison.execution.provenance import provenance
from comparison.execution.resume import changed, command_line, resume_hint
from comparison.execution.runner import Computed, Runner, longest_first
from comparison.execution.task_results import TaskResults
from comparison.execution.workers import workers
from comparison.registry import chosen_analyses, first_tasks
from comparison.report.assemble import assemble
from comparison.report.findings import Fault, Findings, collect_findings
from comparison.report.results.study import Results
from comparison.study.models import MODEL_HIERARCHY, Model, with_max_work, with_softened_bars
from comparison.study.planning import StudyPlan, StudyRequest, plan_study
from comparison.study.refinement import Step
from comparison.study.study import Study
from reference.problem.command import stoppable

import_module("multibody.models.engine")  # workers load it again: where that fails, the command ends here in one line


@command
def main(
    argv: Sequence[str],
    hierarchy: Sequence[Model] = MODEL_HIERARCHY,
    executor: Pool = process_pool,
    models: Engines | None = None,
) -> int:
    """
    Run the study the command line asks for.

    Parameters
    ----------
    argv : sequence of str, optional
        Words of the command line; those of this process if none are given.
    hierarchy : sequence of Model
        The models, each adding one effect to the one before.
    executor : Executor or callable
        What makes an executor for a number of workers, or any executor, which is left open.
    models : mapping of str to callable or str, optional
        Engines of the user by name, as `--model` enters them: a function at the top level of a module, or its place as
        "module:function".

    Returns
    -------
    int
        Exit code.
    """
    began = start_time()
    with stoppable():
        try:
            argv = changed(argv, as_words(models or {}))
            options = parsed(argv)
            console = wide_console()
            plan = _chosen(options, hierarchy)
            if options.budget is not None:
                allotment(plan.study, options.budget, options.jobs)  # refuses what nothing fits
            print_models_left_out(console, plan.study)
            if options.plan:
                print_plan(console, plan.study, options)
            if options.tolerance is not None:
                print_tolerance(console, plan, options)
            return 0 if options.plan else _ended(plan, options, console, argv, executor, began)
        except KeyboardInterrupt:
            print("interrupted before anything was computed", file=sys.stderr)
            return 130


def _chosen(options: Options, hierarchy: Sequence[Model]) -> StudyPlan:
    """What is computed; under a budget, of what as much is computed as fits."""
    hierarchy = with_softened_bars(hierarchy, options.scenes)
    if options.max_work is not None:
        hierarchy = with_max_work(hierarchy, options.max_work)
    hierarchy = (*hierarchy, *options.models)
    return plan_study(
        StudyRequest(
            options.scenes,
            hierarchy,
            options.tolerance,
            options.grid,
            options.full,
            budgeted=options.budget is not None,
            tries=options.plan,
            selection=options.selection,
        )
    )


def _ended(
    plan: StudyPlan, options: Options, console: Console, words: Sequence[str], executor: Pool, began: Clock
) -> int:
    """The exit code; whatever ends the run early, what is finished is kept, and the line printed says how to go on."""
    study, store = plan.study, Cache(store_beside(options.out))
    models = {model.amplification for model in study.hierarchy}

    def hint(rest: Sequence[str]) -> str:
        return resume_hint(store, rest, batches=len(study.batches()))

    with ending_early(hint, words, options.scheduler):
        with workers(options.jobs, options.scheduler, models, executor) as (width, make):
            results, findings = _found(plan, replace(options, jobs=width), console, words, make, store)
        took = Clock.now().since(began)  # the workers have ended: their processor time is known
        times = {"wall_seconds": round(took.wall, 1), "processor_seconds": round(took.processor, 1)}
        results = results.model_copy(update={"run": results.run.model_copy(update=times)})
        return _reported(results, findings, options, console, words)


def _found(
    plan: StudyPlan,
    options: Options,
    console: Console,
    words: Sequence[str],
    executor: Callable[[int], Executor],
    store: Cache,
) -> tuple[Results, Findings]:
    """What the report is made from; its times are not known yet."""
    from comparison.report.report import drawing_tasks  # plotting: not needed to refuse or to plan

    begin, began = time.monotonic(), datetime.now(UTC)
    clear_dead(options.out)
    study = plan.study
    analyses = chosen_analyses(study)
    first = first_tasks(study, analyses)
    keys = [batch_key(batch) for batch in study.batches()]
    store.trim(keys)
    if options.fresh:  # gone before anything is computed: what an interrupted run left is new
        store.forget(keys)
        store.remove(map(task_key, first))

    runner = Runner(TaskResults(store, options.fresh), console, options.jobs, executor)
    unfinished: Sequence[tuple[Step, float]] = ()
    if options.budget is None:
        computed = runner.run_study(study, first)
    else:
        spent, runner = spend(runner, study, options.budget, begin)
        study, computed, unfinished = spent.study, spent.computed, spent.unfinished
        analyses = chosen_analyses(study)
    surfaces = labeled_surfaces(study, computed.batches, computed.answers)
    study = with_silent_models(study, surfaces)
    later = [analysis for analysis in analyses if analysis.needs_surfaces]
    tasks = [task for analysis in later for task in analysis.tasks(study.selecting(analysis.key), surfaces)]
    if tasks:
        console.print("Computing what the surfaces choose, and drawing the figures of the report.")
    runner.run_tasks(tasks, order=longest_first if options.budget is None else drawings_first)

    run: dict[str, Any] = {
        "command": command_line(words),
        "began": began.isoformat(timespec="seconds"),
        "wall_seconds": 0.0,
        "processor_seconds": 0.0,
        "tiles": len(computed.batches),
        "tiles_stored_before": computed.stored,
        "parts": {
            stage: {"tasks": part.tasks, "stored_before": part.stored, "seconds": round(part.seconds, 2)}
            for stage, part in runner.results.parts.items()
        },
        "jobs": options.jobs,
        "choice": targets_met(plan, study, options.tolerance, options.budget, unfinished, surfaces)
        if options.by_trade
        else None,
        "provenance": provenance(),
    }
    findings = collect_findings(
        study,
        surfaces,
        {
            analysis.key: analysis.collect(study.selecting(analysis.key), surfaces, runner.results)
            for analysis in analyses
        },
        _faults(study, computed),
        run,
        families=[family for family in options.families if len(family.scenes) > 1] or None,
        **{
            name: None if analysis in study.absent else _taken_up(load, options.out)
            for name, (analysis, load) in TAKEN_UP.items()
        },
    )
    results = assemble(findings)
    drawings = drawing_tasks(results, findings)
    runner.run_tasks(drawings)
    files = {task.key: runner.results[task].value for task in drawings}
    return results, replace(findings, drawings={key: value for key, value in files.items() if value})


def _reported(results: Results, findings: Findings, options: Options, console: Console, words: Sequence[str]) -> int:
    """Write the report and say what is in it; the exit code."""
    from comparison.report.report import write_report  # likewise

    console.print("Writing the report.")
    with writing(options.out), atomic_replace(options.out) as report:
        write_report(report.folder, results, findings)
    place = options.out if report.place == options.out.resolve() else report.place
    print_faults(results)
    print_closing(console, results, options, words, place)
    if options.check:
        print_check(results)
    return 1 if options.check and results.broken else 0


def _faults(study: Study, computed: Computed) -> list[Fault]:
    """What solvers reported, once for each scene, model and message."""
    titles = {model.key: model.title for model in study.hierarchy}
    faults = {
        Fault(batch.scene.name, f"{titles[batch.model]}: {answer.error_message}")
        for batch, answer in zip(computed.batches, computed.answers)
        if answer.error_message
    }
    return sorted(faults, key=lambda fault: fault.line)


def _taken_up(load: Callable[[Path], Any], out: Path) -> Any:
    """What another command left beside the report; a file that has appeared since and is none of theirs is left."""
    try:
        return load(out)
    except (OSError, ValueError) as error:
        on_stderr(str(error))
        return None
