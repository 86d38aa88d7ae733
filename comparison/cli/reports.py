"""Reports of a run: one after each level, which replaces the one before."""

import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime, timedelta
from functools import partial
from pathlib import Path
from typing import Any

import xarray as xr

from comparison.cli.arguments import format_command_line, report_write_errors
from comparison.cli.options import Options
from comparison.cli.start import Clock
from comparison.registry import FEATURES, list_first_tasks, make_report, select_analyses
from comparison.report.feature import ResultField
from comparison.report.results import Results
from comparison.report.section import Report
from comparison.runner.attempts import LostParts
from comparison.runner.environment import describe_provenance
from comparison.runner.output import print_on_stderr, replace_report
from comparison.runner.runner import Runner, make_compiling_task
from comparison.runner.task import Task
from comparison.runner.task_results import TaskResults
from comparison.study.levels import StudyLevel
from comparison.study.study import Study
from comparison.surfaces.alerts import Alert
from comparison.surfaces.missing_values import leave_out_empty_models
from comparison.surfaces.surfaces import collect_batch_results, label_surfaces, make_surface_tasks

MIN_REPORT_INTERVAL = 3.0  # s, shortest time from one report of a run to the next; the last level's is always written


@dataclass(frozen=True)
class CompleteLevel:
    """Level of a run, that is the study on one grid of phases, of which everything is computed."""

    level: StudyLevel
    study: Study  # the study of the level without models that have no values
    tasks: Sequence[Task]  # tasks that computed `surfaces`
    surfaces: xr.Dataset  # amplification by scene, model, body and phases


def compute_level(level: StudyLevel, runner: Runner) -> CompleteLevel:
    """Compute the amplification surfaces of a level (grid of phases), then the analyses that need them."""
    analyses = select_analyses(level.study)
    tasks = make_surface_tasks(level.study)
    runner.run([*tasks, *list_first_tasks(level.study, analyses)], make_compiling_task)
    batches = [task.argument for task in tasks]
    surfaces = label_surfaces(level.study, batches, collect_batch_results(tasks, runner.results))
    study = leave_out_empty_models(level.study, surfaces)
    later = [analysis for analysis in analyses if analysis.needs_surfaces]
    runner.run([task for each in later for task in each.tasks(study.restrict_to(each.key), surfaces)])
    return CompleteLevel(level, study, tasks, surfaces)


class ReportWriter:
    """
    Writer of the report of each level (grid of phases) of a run.

    place: folder of the reports, which is next to that of the options if this one holds something else. results, level:
    those of the last report, None before the first. seconds: longest time that a report took to write, s.
    """

    def __init__(self, options: Options, jobs: int, words: Sequence[str], began: Clock) -> None:
        """
        Prepare the writer; no report is written yet.

        jobs: number of workers. words: those of the command line. began: when the run began.
        """
        self._options, self._jobs, self._words, self._began = options, jobs, words, began
        self._last = began.wall
        self.place = options.out
        self.results: Results | None = None
        self.level: StudyLevel | None = None
        self.seconds = 0.0

    def is_due(self, complete: CompleteLevel, runner: Runner) -> bool:
        """Return whether a level has new results and the last report is old enough for another one."""
        new = any(task.key not in runner.results.stored for task in complete.tasks)
        return new and time.monotonic() - self._last >= MIN_REPORT_INTERVAL

    def write(self, complete: CompleteLevel, runner: Runner) -> Results:
        """Write the report of a level (grid of phases) and return the level's results."""
        from comparison.report.writing import write_report  # imported late: a run refused or planned needs no plots

        begin = time.monotonic()
        report = self._report(complete, runner)
        results = report.results
        with report_write_errors(self._options.out), replace_report(self.place) as staged:
            write_report(staged.folder, report)
        self.place = self._options.out if staged.place == self._options.out.resolve() else staged.place
        self.results, self.level, self._last = results, complete.level, time.monotonic()
        self.seconds = max(self.seconds, self._last - begin)
        return results

    def write_stopped(self, complete: CompleteLevel | None, runner: Runner) -> None:
        """Write the report of an interrupted run: its last complete level, if any, with the finished analyses."""
        if complete is None:
            return
        later = complete.study.selection.later
        whole = replace(complete.study, selection=complete.study.selection.without(()))
        unfinished = []
        for analysis in select_analyses(whole):
            if analysis.key in later:
                tasks = analysis.tasks(whole.restrict_to(analysis.key), complete.surfaces)
                if not tasks or runner.results.find_missing(tasks):
                    unfinished.append(analysis.key)
        if self.level is not complete.level or set(unfinished) != set(later):
            study = replace(complete.study, selection=whole.selection.without(unfinished))
            self.write(replace(complete, study=study), runner)

    def _report(self, complete: CompleteLevel, runner: Runner) -> Report:
        """Return the content of the report on a level (grid of phases): study, surfaces, analyses, facts of the run."""
        study, surfaces, took = complete.study, complete.surfaces, Clock.now().since(self._began)
        of_surfaces = {task.stage for task in complete.tasks}
        run: dict[str, Any] = {
            "command": format_command_line(self._words),
            "began": (datetime.now(UTC) - timedelta(seconds=took.wall)).isoformat(timespec="seconds"),
            "wall_seconds": round(took.wall, 1),
            "processor_seconds": round(took.processor, 1),
            "tiles": len(complete.tasks),
            "tiles_stored_before": sum(task.key in runner.results.stored for task in complete.tasks),
            "parts": {
                stage: {"tasks": part.tasks, "stored_before": part.stored, "seconds": round(part.seconds, 2)}
                for stage, part in runner.results.parts.items()
                if stage not in of_surfaces
            },
            "jobs": self._jobs,
            "level": complete.level.number,
            "levels": complete.level.of,
            "provenance": describe_provenance(),
        }
        lost = LostParts()
        found: dict[str, Any] = {}
        for analysis in select_analyses(study):
            collect = partial(analysis.collect, study.restrict_to(analysis.key), surfaces, runner.results)
            found[analysis.key] = lost.attempt(f"section {analysis.key}", collect)
        fields = [field for feature in FEATURES if feature.key not in study.absent for field in feature.stored]
        found |= {field.name: _load_stored(field, self._options.out) for field in fields}
        families = [family for family in self._options.families if len(family.scenes) > 1]
        faults = _list_solver_messages(complete.tasks, runner.results)
        return make_report(study, surfaces, found, faults, run, families=families, lost=lost.lines)


def _list_solver_messages(tasks: Sequence[Task], results: TaskResults) -> list[Alert]:
    """Return the messages that solvers reported as alerts, once for each scene, model and text."""
    texts = {
        (task.argument.scene.name, f"{task.stage}: {result.error_message}")
        for task, result in zip(tasks, collect_batch_results(tasks, results))
        if result.error_message
    }
    return [Alert(level="amber", kind="fault", scene=scene, text=text, help="") for scene, text in sorted(texts)]


def _load_stored(field: ResultField[Any], out: Path) -> Any:
    """Return the result that another command stored in the report's folder; None if its file is unreadable."""
    assert field.load is not None
    try:
        return field.load(out)
    except (OSError, ValueError) as error:
        print_on_stderr(str(error))
        return None
