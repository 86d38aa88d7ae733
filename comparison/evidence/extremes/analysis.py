"""The matrix of extremes as an analysis: each model's answer, the same asked more strictly, and the verdict."""

import time
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from pydantic import ValidationError

from comparison.evidence.extremes.causes import CAUSES
from comparison.evidence.extremes.columns import COLUMNS, EQUATIONS, REFERENCE, ModelColumn
from comparison.evidence.extremes.matrix import CellVerdict, Extreme, Matrix, MatrixEntry
from comparison.evidence.extremes.rows import ExtremeCase
from comparison.json_file import finite_or_none
from comparison.result_types import Array
from comparison.runner.task import Task, TaskResult
from comparison.runner.task_results import TaskResults
from comparison.study.batches import import_function
from comparison.wording import exception_line
from reference.problem import Outcome, Scene
from reference.problem.scene import KEYS
from reference.problem.validation import first_scene_error

Finer = tuple[str, Array, Array]  # status, mu and error of a finer run at a phase pair

PHYSICS = {Outcome.RIM_REACHED, Outcome.TRAVEL_REACHED, Outcome.CONTACT_LOST, Outcome.OVERTURNED, Outcome.PAINLEVE}
PHYSICS |= {Outcome.NON_FINITE_LOAD, Outcome.NO_GROUND_MOTION}
NUMERICS = {Outcome.TOLERANCE_NOT_MET, Outcome.STEP_LIMIT, Outcome.SOLVER_FAILED}
FINE = 0.1  # share of the tolerance within which a run must know the value to confirm it, if not as well as claimed
ROUNDING = 1e-12  # relative: two runs this close are the same
BRIEF = {"lubrication, s/m", "start at the friction limit", "outside the rules"}  # for the engine's models, too
STAGE = "extremes"  # of the tasks, on the terminal
LIMIT = 300.0  # s of processor time for one cell with its finer runs: twice what the dearest takes on a busy machine
SECONDS_OF_LONG_ROWS = 30.0  # in place of the column's, recorded for the equations
FAILURES = {Outcome.TIME_LIMIT: "hangs:", Outcome.WORKER_DIED: "crashes:"}  # failures of processes; all else was raised
STRICTEST = 1e-10  # relative error that a model can be asked for


@dataclass(frozen=True)
class Reply:
    """Answer of a model: as `reference.problem.Amplification`, or `invalid` (its rule) or `raised` (what)."""

    mu: Array
    error: Array
    status: tuple[str, ...]
    invalid: str = ""
    raised: str = ""


def judge_reply(
    reply: Reply, finer: Sequence[Reply], tolerance: float, invalid: bool, right: Sequence[str]
) -> MatrixEntry:
    """The verdict on the worst phase pair of an answer; finer: answers to the same question, the most trusted first."""
    if reply.raised:
        return MatrixEntry(CellVerdict.FAILED, f"raises {reply.raised}")
    if reply.invalid:
        return MatrixEntry(CellVerdict.REFUSED if invalid else CellVerdict.FAILED, reply.invalid)
    if invalid:
        return MatrixEntry(CellVerdict.FAILED, "accepts an input that is against the rules")
    points = [_judge_point(reply, m, finer, tolerance, right) for m in range(len(reply.status))]
    order = list(CellVerdict)
    return max(points, key=lambda point: (order.index(point.verdict), point.error or 0.0))


def _judge_point(reply: Reply, m: int, finer: Sequence[Reply], tolerance: float, right: Sequence[str]) -> MatrixEntry:
    status, mu, error = reply.status[m], reply.mu[m], reply.error[m]
    replies = [(other.status[m], other.mu[m], other.error[m]) for other in finer if len(other.status) > m]
    if status not in (PHYSICS | NUMERICS | {Outcome.OK}):
        return MatrixEntry(CellVerdict.FAILED, f"status {status!r} is no answer of a model", status)
    if right and status != Outcome.OK and status not in right:
        return MatrixEntry(CellVerdict.FAILED, f"refused as {status!r} instead of {' or '.join(right)}", status)
    if status in (Outcome.OK, Outcome.TOLERANCE_NOT_MET):
        return _judge_value(status, mu, error, replies, tolerance)
    if not np.isnan(mu).all():
        return MatrixEntry(CellVerdict.FAILED, f"{status}, and yet a value", status)
    if status in NUMERICS:
        return MatrixEntry(CellVerdict.LIMIT, status, status)
    answered = next((other for other, _, _ in replies if other not in NUMERICS), status)
    if answered != status and status not in right:
        return MatrixEntry(CellVerdict.FAILED, f"{status}, but a finer run: {answered}", status)
    return MatrixEntry(CellVerdict.REFUSED, status, status)


def _judge_value(status: str, mu: Array, error: Array, finer: Sequence[Finer], tolerance: float) -> MatrixEntry:
    """Judge a value with its error estimate."""
    known = [(value, estimate) for _, value, estimate in finer if np.isfinite(value).all()]
    refused = next((other for other, _, _ in finer), "none")
    unconfirmed = MatrixEntry(CellVerdict.FAILED, f"{status}, but no finer run confirms it: {refused}", status)
    if np.isfinite(mu).all() and np.isnan(error).all():
        return _judge_without_error(status, mu, known[0][0], tolerance) if known else unconfirmed
    if not (np.isfinite(mu).all() and np.isfinite(error).all()):
        return MatrixEntry(CellVerdict.FAILED, f"{status}, but no finite number", status)
    share = float((error / np.abs(mu)).max()) if (mu != 0.0).all() else float("inf")
    if (error < 0.0).any() or (status == Outcome.OK and share > tolerance * (1.0 + ROUNDING)):
        reason = f"{status} with an error estimate of {share:.1e}, asked: {tolerance:g}"
        entry = MatrixEntry(CellVerdict.FAILED, reason, status)
    else:
        entry = _judge_by_finer_runs(status, mu, error, share, known, tolerance) or unconfirmed
    return replace(entry, error=finite_or_none(share))


def _judge_by_finer_runs(
    status: str, mu: Array, error: Array, share: float, known: Sequence[tuple[Array, Array]], tolerance: float
) -> MatrixEntry | None:
    """Judge a value with a share of it as its error by finer runs, the most trusted first; None where none tells."""
    for value, estimate in known:
        if reason := _word_contradiction(mu, error, value, estimate):
            return MatrixEntry(CellVerdict.FAILED, reason, status)
        if status == Outcome.OK and (estimate <= np.maximum(error, FINE * tolerance * np.abs(mu))).all():
            return MatrixEntry(CellVerdict.CONVERGED, f"error {share:.1e} confirmed", status)
    if status == Outcome.TOLERANCE_NOT_MET:
        return MatrixEntry(CellVerdict.LIMIT, f"{status}: {share:.1e}", status)
    return None


def _word_contradiction(mu: Array, error: Array, value: Array, estimate: Array) -> str:
    """Return by how much a finer run contradicts a value and its error, "" where it does not."""
    off, allowed = np.abs(mu - value), error + estimate + ROUNDING * np.abs(mu)
    worst = int((off / allowed).argmax())
    times = off[worst] / allowed[worst]
    if not off[worst] > allowed[worst]:
        return ""
    return f"mu_{worst + 1} is off by {off[worst] / abs(mu[worst]):.1e}, {times:.2g} times what is claimed"


def _judge_without_error(status: str, mu: Array, value: Array, tolerance: float) -> MatrixEntry:
    """Judge a value that states no error, by whether it is as close to that of a finer run as was asked."""
    with np.errstate(divide="ignore", invalid="ignore"):
        difference = float(np.nan_to_num(np.abs(mu - value) / np.abs(value), nan=0.0).max())
    verdict = CellVerdict.CONVERGED if difference <= tolerance else CellVerdict.LIMIT
    return MatrixEntry(verdict, f"states no error, off by {difference:.1e}", status)


@dataclass(frozen=True)
class Cell:
    """An extreme and the model that meets it."""

    row: ExtremeCase
    column: ModelColumn


def list_cells(rows: Sequence[ExtremeCase], columns: Sequence[ModelColumn] = COLUMNS) -> list[Cell]:
    """Every model that each extreme concerns; of the numerics of our engine none is for an engine of the user."""
    pairs = [(row, column) for row in rows for column in columns if (column.like or column.key) in row.columns]
    return [Cell(row, column) for row, column in pairs if not (column.like and row.amplification)]


def solve_cell(cell: Cell) -> MatrixEntry:
    """Ask the model, ask for more accuracy until that confirms or contradicts the answer, and judge."""
    row, column = cell.row, cell.column
    tolerance = float(row.settings.get("tolerance", column.tolerance))
    begin = time.process_time()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # overflow in an extreme is judged by what comes of it
        function = row.amplification or column.amplification
        reply = _ask_model(row, function, {**column.settings, **row.settings, "tolerance": tolerance})
        seconds = time.process_time() - begin
        finer = []
        for other, settings, usual in column.finer if has_claim(reply) else ():
            # another function knows only what its own settings name
            known = {key: value for key, value in row.settings.items() if other == function or key in settings}
            strict = max(usual * min(1.0, tolerance / column.tolerance), STRICTEST)
            finer.append(_ask_model(row, other, {**settings, **known, "tolerance": strict}))
            if finer[-1].status and NUMERICS.isdisjoint(finer[-1].status):  # an answer, be it a refusal, at every point
                break
    entry = judge_reply(reply, finer, tolerance, row.invalid, row.right)
    cause = CAUSES.get((row.group, row.title), {}).get(column.key) if entry.verdict == CellVerdict.LIMIT else None
    reason = " ".join(": ".join(filter(None, (entry.reason, cause))).split())
    total = time.process_time() - begin
    return replace(entry, reason=reason, seconds=round(seconds, 3), total=round(total, 3))


def has_claim(reply: Reply) -> bool:
    """
    Return whether there is anything that a finer run could contradict: not a value whose error is as large as itself.
    """
    return not (reply.invalid or reply.raised) and any(
        (error < np.abs(mu)).any() if status == Outcome.TOLERANCE_NOT_MET else status not in NUMERICS
        for status, mu, error in zip(reply.status, reply.mu, reply.error)
    )


def _ask_model(row: ExtremeCase, function: str, settings: Mapping[str, Any]) -> Reply:
    """Return what a function replies at the row's phase pairs; one of the engine does the work that the row allows."""
    nothing = np.empty((0, 0))
    settings = {key: row.max_work if key == "max_work" else value for key, value in settings.items()}
    try:
        scene = read_scene(row.scene)
        result = import_function(function)(scene, np.array(row.phases), **settings)
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
        return Scene.model_validate({**stated, "name": "extreme"})
    except ValidationError as error:
        raise first_scene_error("extreme", error, KEYS) from None


@dataclass(frozen=True)
class Extremes:
    """Every model at every extreme, in scenes of their own; limit: most processor time of one cell, s, rounded up."""

    rows: Sequence[ExtremeCase]
    columns: Sequence[ModelColumn] = COLUMNS
    limit: float = LIMIT

    def tasks(self) -> list[Task]:
        """One task for each cell, row by row."""
        return [self._task(cell) for cell in list_cells(self.rows, self.columns)]

    def collect(self, results: TaskResults) -> Matrix:
        """The matrix, without what the command knows of the run."""
        entries: dict[tuple[str, str], dict[str, MatrixEntry]] = {}
        for cell in list_cells(self.rows, self.columns):
            row = entries.setdefault((cell.row.group, cell.row.title), {})
            row[cell.column.key] = results.value(self._task(cell), _entry_of_failure)
        used = {key for row in entries.values() for key in row}
        titles = {column.key: column.title for column in self.columns if column.key in used}
        return Matrix(titles, [Extreme(group, title, row) for (group, title), row in entries.items()], {})

    def _task(self, cell: Cell) -> Task:
        """The cell's, which waits for the compiled reference only if it asks the equations."""
        row, column = cell.row, cell.column
        functions = {row.amplification or column.amplification, *(function for function, _, _ in column.finer)}
        seconds, compiled = column.seconds if row.quick else SECONDS_OF_LONG_ROWS, EQUATIONS in functions
        group = column.key if column.like else ""
        return Task(solve_cell, cell, STAGE, seconds, None, compiled, self.limit, group)


def _entry_of_failure(cell: Cell, failed: TaskResult) -> MatrixEntry:
    reason = f"{FAILURES.get(failed.outcome, 'raises')} {failed.error_message}"
    return MatrixEntry(CellVerdict.FAILED, reason, failed.outcome.value)


def select_quick(every: Sequence[ExtremeCase]) -> list[ExtremeCase]:
    """The extremes that take a fraction of a second, mostly without the models of the engine."""
    chosen = [
        replace(row, columns=tuple(key for key in row.columns if key in REFERENCE or row.group in BRIEF))
        for row in every
        if row.quick
    ]
    return [row for row in chosen if row.columns]
