"""The matrix of extremes as an analysis: a task for every cell, each with a limit on its processor time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import xarray as xr

from comparison.analyses.extremes.cells import Cell, cells, solve_cell
from comparison.analyses.extremes.matrix import Entry, Extreme, Matrix
from comparison.analyses.extremes.rows import COLUMNS, EQUATIONS, REFERENCE, Column, Row
from comparison.analyses.extremes.verdicts import Verdict
from comparison.runner.analysis import Analysis
from comparison.runner.task import Task, TaskResult
from comparison.runner.task_results import TaskResults
from comparison.study.study import Study
from reference.problem import Outcome

BRIEF = {"lubrication, s/m", "start at the friction limit", "outside the rules"}  # for the engine's models, too
LIMIT = 300.0  # s of processor time for one cell with its finer runs: twice what the dearest takes on a busy machine
SECONDS_OF_LONG_ROWS = 30.0  # in place of the column's, recorded for the equations
FAILURES = {Outcome.TIME_LIMIT: "hangs:", Outcome.WORKER_DIED: "crashes:"}  # of processes; all else was raised


@dataclass(frozen=True)
class Extremes(Analysis[Matrix]):
    """Every model at every extreme, in scenes of their own; limit: most processor time of one cell, s, rounded up."""

    key, stage = "extremes", "extremes"
    rows: Sequence[Row]
    columns: Sequence[Column] = COLUMNS
    limit: float = LIMIT

    def tasks(self, study: Study | None = None, surfaces: xr.Dataset | None = None) -> list[Task]:
        """One task for each cell, row by row."""
        return [self._task(cell) for cell in cells(self.rows, self.columns)]

    def collect(self, study: Study | None, surfaces: xr.Dataset | None, results: TaskResults) -> Matrix:
        """The matrix, without what the command knows of the run."""
        entries: dict[tuple[str, str], dict[str, Entry]] = {}
        for cell in cells(self.rows, self.columns):
            row = entries.setdefault((cell.row.group, cell.row.title), {})
            row[cell.column.key] = results.value(self._task(cell), _failed)
        used = {key for row in entries.values() for key in row}
        titles = {column.key: column.title for column in self.columns if column.key in used}
        return Matrix(titles, [Extreme(group, title, row) for (group, title), row in entries.items()], {})

    def _task(self, cell: Cell) -> Task:
        """The cell's, which waits for the compiled reference only if it asks the equations."""
        row, column = cell.row, cell.column
        functions = {row.amplification or column.amplification, *(function for function, _, _ in column.finer)}
        return Task(
            solve_cell,
            cell,
            self.stage,
            column.seconds if row.quick else SECONDS_OF_LONG_ROWS,
            needs_compiled_reference=EQUATIONS in functions,
            timeout=self.limit,
            group=column.key if column.like else "",
        )


def _failed(cell: Cell, failed: TaskResult) -> Entry:
    """In place of a verdict: the model has failed with its process."""
    reason = f"{FAILURES.get(failed.outcome, 'raises')} {failed.error_message}"
    return Entry(Verdict.FAILED, reason, failed.outcome.value, None, None, None)


def reduced(every: Sequence[Row]) -> list[Row]:
    """The extremes that take a fraction of a second, mostly without the models of the engine."""
    chosen = [
        replace(row, columns=tuple(key for key in row.columns if key in REFERENCE or row.group in BRIEF))
        for row in every
        if row.quick
    ]
    return [row for row in chosen if row.columns]
