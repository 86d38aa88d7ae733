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
    from comparison.cli.start import run_command

    run_command("comparison.run")  # does not return: it imports this module under its own name and runs it

import sys
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from importlib import import_module

from comparison.cli.arguments import (
    EndedEarlyError,
    command,
    edit_command_line,
    format_command_line,
    word_resume_hint,
)
from comparison.cli.closing import print_check, print_closing, print_level, print_solver_messages
from comparison.cli.computing import open_workers
from comparison.cli.options import Options, parse_options
from comparison.cli.reports import CompleteLevel, ReportWriter, compute_level
from comparison.cli.start import Clock, find_command_start
from comparison.cli.terminal import print_models_left_out, print_plan, print_stored
from comparison.cli.user_models import Engines, word_engine_options
from comparison.registry import (
    estimate_stage_seconds,
    estimate_study_seconds,
    list_first_tasks,
    make_study_levels,
    select_analyses,
)
from comparison.runner.cache import Cache, locate_store
from comparison.runner.output import remove_abandoned_reports
from comparison.runner.processes import Pool, make_process_pool
from comparison.runner.progress import Deadline, TimeUpError, make_wide_console, show_progress
from comparison.runner.runner import Runner
from comparison.runner.task import Task
from comparison.runner.task_results import TaskResults
from comparison.study.costs import WRITING_SECONDS
from comparison.study.models import MODEL_HIERARCHY, Model, with_max_work, with_steps_of_scenes
from comparison.study.study import Study
from comparison.surfaces.surfaces import make_surface_tasks
from reference.support.command import stop_on_signals

# Load Exudyn here, as worker processes will: if that fails, the command ends at once with one line.
import_module("multibody.models.engine")


@command
def main(
    argv: Sequence[str],
    hierarchy: Sequence[Model] = MODEL_HIERARCHY,
    executor: Pool = make_process_pool,
    models: Engines | None = None,
) -> int:
    """
    Run the study that the command line asks for; return the exit code.

    argv: words of the command line; those of this process if none are given. hierarchy: the models, each adding one
    effect to the one before. executor: what makes an executor for a number of workers, or any executor, which is left
    open. models: engines of the user by name, as `--model` enters them: a function at the top level of a module, or its
    place as "module:function".
    """
    began = find_command_start()
    with stop_on_signals():
        try:
            words = edit_command_line(argv, word_engine_options(models or {}))
            options = parse_options(words)
            run = StudyRun(options, words, hierarchy, began)
            run.describe()
            if options.plan:
                run.plan()
                return 0
            code = run.compute(executor)
            if options.check and code < 2 and any(scene.acceptance.confirm for scene in options.scenes):
                words = _tighter_command(options, words)
                run.say(f"Again at a tenth of the tolerance: {format_command_line(words)}")
                again = StudyRun(parse_options(words), words, hierarchy, Clock.now()).compute(executor)
                return max(code, again)
            return code
        except KeyboardInterrupt:
            print("interrupted before anything was computed", file=sys.stderr)
            return 130


def _tighter_command(options: Options, words: Sequence[str]) -> list[str]:
    """Return a command that computes only the differences of models again, at a tenth of the tolerance."""
    place = options.out.with_name(f"{options.out.name}-tighter")
    tighter = ["--tolerance", f"{options.tolerance / 10.0:g}", "--out", str(place), "--only", "differences,budget"]
    return edit_command_line(words, tighter, options=["--tolerance", "--out", "--only", "--skip", "--also"])


def _make_study(options: Options, hierarchy: Sequence[Model]) -> Study:
    """Return the study that the options describe: scenes, grid, tolerance, models and analyses."""
    hierarchy = with_steps_of_scenes(hierarchy, options.scenes)
    if options.max_work is not None:
        hierarchy = with_max_work(hierarchy, options.max_work)
    hierarchy = (*hierarchy, *options.models)
    return Study(
        options.scenes,
        grid=options.grid,
        tolerance=options.tolerance,
        hierarchy=hierarchy,
        full=options.full,
        selection=options.selection,
    )


class StudyRun:
    """
    A study that the command line asks for: planned only, or computed in steps (levels) of finer grids and reported.

    Whatever ends it early, finished results are kept, and a printed line says how to continue.
    """

    def __init__(self, options: Options, words: Sequence[str], hierarchy: Sequence[Model], began: Clock) -> None:
        """Make the study that the options describe, and the cache of its results next to the report."""
        self._options, self._words, self._began = options, words, began
        self._study, self._console = _make_study(options, hierarchy), make_wide_console()
        self._cache = Cache(locate_store(options.out))

    def describe(self) -> None:
        """Print the properties read of each scene, implausible values, and scenes that lack data for a model."""
        print_models_left_out(self._console, self._study)

    def plan(self) -> None:
        """Print what would be computed, and roughly how long it would take."""
        print_plan(self._console, self._study, self._options)

    def compute(self, executor: Pool) -> int:
        """Compute the study on worker processes or a cluster, print its results; return the exit code."""
        options, models = self._options, {model.amplification for model in self._study.hierarchy}
        with open_workers(options.jobs, options.scheduler, models, executor, self._words, self._hint) as (jobs, pool):
            remove_abandoned_reports(options.out)
            surfaces = make_surface_tasks(self._study)
            results = self._open_results(surfaces)
            stages = estimate_stage_seconds(self._study)
            total = WRITING_SECONDS + estimate_study_seconds(self._study, stages)
            reports = ReportWriter(options, jobs, self._words, self._began)
            with (
                show_progress(self._console, total, jobs) as display,
                Deadline(self._began.wall, options.budget) as deadline,
            ):
                runner = Runner(results, jobs, pool, display, stages)
                stop = self._compute_levels(runner, surfaces, reports, deadline)
            return self._close(reports, jobs, stop)

    def _close(self, reports: ReportWriter, jobs: int, stop: KeyboardInterrupt | None) -> int:
        """
        Print the results of the last report and what to do next; return the exit code.

        stop: the interrupt that ended the run, if any; it is raised again. Raises EndedEarlyError without a report.
        """
        options, found = replace(self._options, jobs=jobs), reports.results
        if found is not None:
            print_solver_messages(found)
            print_closing(self._console, found, options, self._words, reports.place)
            if options.check:
                print_check(found, options.scenes)
        if stop is not None:
            raise stop
        if found is None:
            rule = "no level of the study was complete by then"
            line = f"command line: --budget = {options.budget:g}: {rule}: {self._hint(self._words)}"
            raise EndedEarlyError(3, line)
        return 1 if options.check and found.broken else 0

    def say(self, line: str) -> None:
        """Print a text on one line, without wrapping it."""
        self._console.print(line, soft_wrap=True)

    def _open_results(self, surfaces: Sequence[Task]) -> TaskResults:
        """
        Open the store of results, print how many earlier runs left, and return it; --fresh removes them first.

        surfaces: tasks that compute the amplification.
        """
        first = list_first_tasks(self._study, select_analyses(self._study))
        keys = [task.key for task in surfaces]
        self._cache.trim(keys)
        if self._options.fresh:  # --fresh: delete stored results first, so that an interrupted run leaves only new ones
            self._cache.remove([*keys, *(task.key for task in first)])
        results = TaskResults(self._cache, self._options.fresh)
        print_stored(self._console, results, surfaces, first)
        return results

    def _compute_levels(
        self, runner: Runner, surfaces: Sequence[Task], reports: ReportWriter, deadline: Deadline
    ) -> KeyboardInterrupt | None:
        """Compute the study from coarse to fine grids, with reports; return the interrupt that ended it, or None."""
        complete: CompleteLevel | None = None
        try:
            planned = make_study_levels(self._study)
            for level in planned if runner.results.find_missing(surfaces) else planned[-1:]:
                complete = compute_level(level, runner)
                if level.last or reports.is_due(complete, runner):
                    before = reports.results
                    said = reports.write(complete, runner)
                    deadline.keep_free(reports.seconds)
                    if not level.last:
                        print_level(self._console, said, before, level, reports.place)
        except TimeUpError:
            deadline.keep_free(0.0)
            with suppress(TimeUpError):  # If the deadline comes while this report is written, the earlier one stays.
                reports.write_stopped(complete, runner)
        except KeyboardInterrupt as stop:
            reports.write_stopped(complete, runner)
            return stop
        return None

    def _hint(self, words: Sequence[str]) -> str:
        """Return in words where finished results are kept, and which command computes the rest."""
        return word_resume_hint(self._cache, words, batches=len(self._study.batches()))
