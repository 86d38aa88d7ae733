"""The matrix of extremes as an analysis: each model's answer, the same asked more strictly, and the verdict."""

from __future__ import annotations

import time
import warnings
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import xarray as xr
from pydantic import ValidationError

from comparison.analyses.extremes.matrix import Entry, Extreme, Matrix, Verdict
from comparison.analyses.extremes.rows import CAUSES, COLUMNS, EQUATIONS, REFERENCE, Column, Row
from comparison.analyses.extremes.verdicts import NUMERICS, Reply, judged
from comparison.runner.analysis import Analysis
from comparison.runner.task import Task, TaskResult
from comparison.runner.task_results import TaskResults
from comparison.study.batches import imported
from comparison.study.study import Study
from comparison.wording import exception_line
from reference.problem import Outcome, Scene
from reference.problem.scene import KEYS
from reference.problem.scene_error import first_error

BRIEF = {"lubrication, s/m", "start at the friction limit", "outside the rules"}  # for the engine's models, too
LIMIT = 300.0  # s of processor time for one cell with its finer runs: twice what the dearest takes on a busy machine
SECONDS_OF_LONG_ROWS = 30.0  # in place of the column's, recorded for the equations
FAILURES = {Outcome.TIME_LIMIT: "hangs:", Outcome.WORKER_DIED: "crashes:"}  # of processes; all else was raised
STRICTEST = 1e-10  # relative error that a model can be asked for


@dataclass(frozen=True)
class Cell:
    """An extreme and the model that meets it."""

    row: Row
    column: Column


def cells(rows: Sequence[Row], columns: Sequence[Column] = COLUMNS) -> list[Cell]:
    """Every model that each extreme concerns, row by row."""
    return [Cell(row, column) for row in rows for column in columns if _concerns(row, column)]


def _concerns(row: Row, column: Column) -> bool:
    """Whether the model meets the extreme; one of the numerics of our engine is none for an engine of the user."""
    return not row.amplification and column.like in row.columns if column.like else column.key in row.columns


def solve_cell(cell: Cell) -> Entry:
    """Ask the model, ask for more accuracy until that confirms or contradicts the answer, and judge."""
    row, column = cell.row, cell.column
    tolerance = float(row.settings.get("tolerance", column.tolerance))
    begin = time.process_time()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # overflow in an extreme is judged by what comes of it
        function = row.amplification or column.amplification
        reply = _ask(row, function, {**column.settings, **row.settings, "tolerance": tolerance})
        seconds = time.process_time() - begin
        finer = list(_finer_replies(cell, function, tolerance)) if answers(reply) else []
    entry = judged(reply, finer, tolerance, row.invalid, row.right)
    cause = CAUSES.get((row.group, row.title), {}).get(column.key) if entry.verdict == Verdict.LIMIT else None
    reason = " ".join(": ".join(filter(None, (entry.reason, cause))).split())
    total = time.process_time() - begin
    return replace(entry, reason=reason, seconds=round(seconds, 3), total=round(total, 3))


def _finer_replies(cell: Cell, answered_by: str, tolerance: float) -> Iterator[Reply]:
    """What the finer runs of the column say, until one has an answer at every point."""
    row, column = cell.row, cell.column
    for function, settings, usual in column.finer:
        share = min(1.0, tolerance / column.tolerance)
        # another function knows only what its own settings name
        known = {key: value for key, value in row.settings.items() if function == answered_by or key in settings}
        reply = _ask(row, function, {**settings, **known, "tolerance": max(usual * share, STRICTEST)})
        yield reply
        if reply.status and NUMERICS.isdisjoint(reply.status):  # an answer, be it a refusal, at every point
            return


def answers(reply: Reply) -> bool:
    """Whether there is anything that a finer run could contradict: not a value whose error is as large as itself."""
    return not (reply.invalid or reply.raised) and any(
        (error < np.abs(mu)).any() if status == Outcome.TOLERANCE_NOT_MET else status not in NUMERICS
        for status, mu, error in zip(reply.status, reply.mu, reply.error)
    )


def _ask(row: Row, function: str, settings: Mapping[str, Any]) -> Reply:
    """What a function replies at the row's phase pairs; one of the engine does the work that the row allows."""
    nothing = np.empty((0, 0))
    settings = {key: row.max_work if key == "max_work" else value for key, value in settings.items()}
    try:
        scene = read_scene(row.scene)
        result = imported(function)(scene, np.array(row.phases), **settings)
        status = tuple(str(outcome) for outcome in result.status)
        return Reply(np.array(result.mu, dtype=float), np.array(result.error, dtype=float), status)
    except Exception as error:
        text = exception_line(error)
        if isinstance(error, ValueError) and not isinstance(error, np.linalg.LinAlgError):
            return Reply(nothing, nothing, (), invalid=text.partition(": ")[2])
        return Reply(nothing, nothing, (), raised=text)


def read_scene(stated: Mapping[str, Any]) -> Scene:
    """The scene of tables and keys, None standing for an absent key. Raises SceneError."""
    try:
        return Scene.model_validate({**_without_none(stated), "name": "extreme"})
    except ValidationError as error:
        raise first_error("extreme", error, KEYS) from None


def _without_none(table: Mapping[str, Any]) -> dict[str, Any]:
    return {
        key: _without_none(value) if isinstance(value, Mapping) else value
        for key, value in table.items()
        if value is not None
    }


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
    return Entry(Verdict.FAILED, reason, failed.outcome.value)


def reduced(every: Sequence[Row]) -> list[Row]:
    """The extremes that take a fraction of a second, mostly without the models of the engine."""
    chosen = [
        replace(row, columns=tuple(key for key in row.columns if key in REFERENCE or row.group in BRIEF))
        for row in every
        if row.quick
    ]
    return [row for row in chosen if row.columns]
