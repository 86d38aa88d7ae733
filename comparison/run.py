"""
The study on the command line: `python -m comparison.run [SCENE ...]`.

The study is computed level by level, from coarse grids to fine ones. Each level has a whole report, which takes the
place of the one before. A deadline and Ctrl-C end the same run early: the report is then that of the last level
that is complete, with every analysis that is finished.

Exit codes: 0 done; 1 a limit of --check is broken; 2 a wrong scene or option, before anything is computed; 3 something
could not be written, no level was complete at the deadline, or an unexpected error; 4 the cluster was lost; 128 +
number of the signal, 130 for Ctrl-C; 141 whoever read the output closed it. After 3, 4 and a signal the same command
goes on where it stopped.
"""

if __name__ == "__main__":
    from comparison.cli.start import start

    start("comparison.run")  # does not return: the module is loaded once, under its own name

import sys
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from functools import partial
from importlib import import_module

from rich.console import Console

from comparison.cli.arguments import EndedEarlyError, changed, command, command_line, resume_hint
from comparison.cli.closing import print_check, print_closing, print_faults, print_level
from comparison.cli.computing import workers
from comparison.cli.options import Options, parsed
from comparison.cli.reports import Complete, Reports, computed_level
from comparison.cli.start import Clock, start_time
from comparison.cli.terminal import print_models_left_out, print_plan, print_stored
from comparison.cli.user_models import Engines, as_words
from comparison.registry import chosen_analyses, first_tasks, levels, seconds_by_stage
from comparison.runner.cache import Cache, store_beside
from comparison.runner.output import clear_dead
from comparison.runner.processes import Pool, process_pool
from comparison.runner.progress import Deadline, TimeUpError, progress, wide_console
from comparison.runner.runner import Runner
from comparison.runner.task_results import TaskResults
from comparison.study.costs import WRITING, seconds_of_model
from comparison.study.models import MODEL_HIERARCHY, Model, with_max_work, with_softened_bars
from comparison.study.study import Study
from comparison.surfaces.surfaces import surface_tasks
from reference.support.command import stop_on_signals

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

    argv: words of the command line; those of this process if none are given. hierarchy: the models, each adding one
    effect to the one before. executor: what makes an executor for a number of workers, or any executor, which is left
    open. models: engines of the user by name, as `--model` enters them: a function at the top level of a module, or its
    place as "module:function".
    """
    began = start_time()
    with stop_on_signals():
        try:
            words = changed(argv, as_words(models or {}))
            options = parsed(words)
            console = wide_console()
            study = _study(options, hierarchy)
            print_models_left_out(console, study)
            if options.plan:
                print_plan(console, study, options)
                return 0
            code = _ended(study, options, console, words, executor, began)
            if options.check and code < 2 and any(scene.acceptance.confirm for scene in options.scenes):
                words = _tighter(options, words)
                console.print(f"Again at a tenth of the tolerance: {command_line(words)}", soft_wrap=True)
                options = parsed(words)
                again = _ended(_study(options, hierarchy), options, console, words, executor, Clock.now())
                return max(code, again)
            return code
        except KeyboardInterrupt:
            print("interrupted before anything was computed", file=sys.stderr)
            return 130


def _tighter(options: Options, words: Sequence[str]) -> list[str]:
    """The command that computes the differences again at a tenth of the tolerance, with a report beside the first."""
    beside = options.out.with_name(f"{options.out.name}-tighter")
    tighter = ["--tolerance", f"{options.tolerance / 10.0:g}", "--out", str(beside), "--only", "differences,budget"]
    return changed(words, tighter, options=["--tolerance", "--out", "--only", "--skip", "--also"])


def _study(options: Options, hierarchy: Sequence[Model]) -> Study:
    """The whole question."""
    hierarchy = with_softened_bars(hierarchy, options.scenes)
    if options.max_work is not None:
        hierarchy = with_max_work(hierarchy, options.max_work)
    hierarchy = (*hierarchy, *options.models)
    return Study(options.scenes, options.grid, options.tolerance, hierarchy, options.full, selection=options.selection)


def _ended(study: Study, options: Options, console: Console, words: Sequence[str], executor: Pool, began: Clock) -> int:
    """The exit code; whatever ends the run early, what is finished is kept, and the line printed says how to go on."""
    store = Cache(store_beside(options.out))
    models = {model.amplification for model in study.hierarchy}
    hint = partial(resume_hint, store, batches=len(study.batches()))
    with workers(options.jobs, options.scheduler, models, executor, words, hint) as (jobs, pool):
        clear_dead(options.out)
        analyses = chosen_analyses(study)
        first = first_tasks(study, analyses)
        surfaces = surface_tasks(study)
        keys = [task.key for task in surfaces]
        store.trim(keys)
        if options.fresh:  # gone before anything is computed: what an interrupted run left is new
            store.remove([*keys, *(task.key for task in first)])
        results = TaskResults(store, options.fresh)
        print_stored(console, results, surfaces, first)
        stages = seconds_by_stage(study)
        total = WRITING + sum(stages.values()) + sum(seconds_of_model(study, model) for model in study.hierarchy)
        reports = Reports(options, jobs, words, began)
        complete: Complete | None = None
        stopped: KeyboardInterrupt | None = None
        with progress(console, total, jobs) as display, Deadline(began.wall, options.budget) as deadline:
            runner = Runner(results, jobs, pool, display, stages)
            try:
                planned = levels(study)
                for level in planned if results.missing(surfaces) else planned[-1:]:
                    complete = computed_level(level, runner)
                    if level.last or reports.is_due(complete, runner):
                        before = reports.results
                        said = reports.write(complete, runner)
                        deadline.keep_free(reports.seconds)
                        if not level.last:
                            print_level(console, said, before, level, reports.place)
            except TimeUpError:
                deadline.keep_free(0.0)
                with suppress(TimeUpError):  # then the report before stays
                    reports.write_stopped(complete, runner)
            except KeyboardInterrupt as stop:
                reports.write_stopped(complete, runner)
                stopped = stop
        found = reports.results
        if found is not None:
            print_faults(found)
            print_closing(console, found, replace(options, jobs=jobs), words, reports.place)
            if options.check:
                print_check(found)
        if stopped is not None:
            raise stopped
        if found is None:
            rule = "no level of the study was complete by then"
            raise EndedEarlyError(3, f"command line: --budget = {options.budget:g}: {rule}: {hint(words)}")
        return 1 if options.check and found.broken else 0
