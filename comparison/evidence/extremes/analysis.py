"""Matrix of extremes as tasks: each model's answer, finer runs of the same question, and the verdict."""

import time
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from pydantic import ValidationError

from comparison.evidence.extremes.causes import CAUSES
from comparison.evidence.extremes.columns import COLUMNS, EQUATIONS, REFERENCE_MODELS, ModelColumn
from comparison.evidence.extremes.matrix import CellVerdict, Extreme, Matrix, MatrixEntry
from comparison.evidence.extremes.rows import ExtremeCase
from comparison.json_file import finite_or_none
from comparison.result_types import Array
from comparison.runner.task import Task, TaskResult
from comparison.runner.task_results import TaskResults
from comparison.study.batches import import_function
from comparison.wording import word_exception
from reference.problem import Outcome, Scene
from reference.problem.scene import KEYS
from reference.problem.validation import first_scene_error

FinerPoint = tuple[str, Array, Array]  # a finer run at one phase pair: status, amplification and its error of each body

# Outcomes of motions that leave the model, or whose loading is absent or not finite: a model rightly gives no value
PHYSICAL_OUTCOMES = {
    Outcome.RIM_REACHED,
    Outcome.TRAVEL_REACHED,
    Outcome.CONTACT_LOST,
    Outcome.OVERTURNED,
    Outcome.PAINLEVE,
}
PHYSICAL_OUTCOMES |= {Outcome.NON_FINITE_LOAD, Outcome.NO_GROUND_MOTION}
# Outcomes that mean that the solver did not reach the accuracy asked, ran out of steps, or failed
NUMERICAL_OUTCOMES = {Outcome.TOLERANCE_NOT_MET, Outcome.STEP_LIMIT, Outcome.SOLVER_FAILED}
# A finer run confirms a result only if its own error is at most the result's, or this share of the tolerance asked.
CONFIRMING_ERROR_SHARE = 0.1
RELATIVE_ROUNDING = 1e-12  # Two amplifications whose relative difference is smaller count as equal.
# Groups of extreme cases that --reduced also computes with Exudyn's models
GROUPS_QUICK_BY_ENGINE = {"lubrication, s/m", "start at the friction limit", "outside the rules"}
STAGE = "extremes"  # name under which the terminal shows the progress of these tasks
# s, processor time after which a model at an extreme, with finer runs, is stopped: twice the slowest on a busy machine
CELL_TIME_LIMIT = 300.0
SECONDS_OF_LONG_ROWS = 30.0  # s, rough processor time of a model at an extreme that takes the equations over a second
# First word of the reason for the verdict FAILED if a worker process timed out or died; if its call raised, "raises"
PROCESS_FAILURES = {Outcome.TIME_LIMIT: "hangs:", Outcome.WORKER_DIED: "crashes:"}
MIN_TOLERANCE = 1e-10  # smallest relative error that a finer run is asked for: models accept no smaller one


@dataclass(frozen=True)
class ModelAnswer:
    """Answer of a model to an extreme case: a result at each phase pair, or the reason why there is none."""

    mu: Array  # amplification, (phase pairs, bodies)
    error: Array  # estimated absolute error of mu, (phase pairs, bodies)
    status: tuple[str, ...]  # outcome of each phase pair
    invalid: str = ""  # rule that the input breaks, in words, if the model refused it
    raised: str = ""  # error that the model raised, in words


def judge_answer(
    reply: ModelAnswer, finer: Sequence[ModelAnswer], tolerance: float, invalid: bool, right: Sequence[str]
) -> MatrixEntry:
    """
    Return the verdict on a model's answer: that on its worst phase pair.

    finer: answers of the finer runs, the most trusted first. tolerance: relative error asked. invalid: whether the
    model must refuse the input. right: outcomes that are correct instead of a value, if they are known.
    """
    if reply.raised:
        return MatrixEntry(CellVerdict.FAILED, f"raises {reply.raised}")
    if reply.invalid:
        return MatrixEntry(CellVerdict.REFUSED if invalid else CellVerdict.FAILED, reply.invalid)
    if invalid:
        return MatrixEntry(CellVerdict.FAILED, "accepts an input that is against the rules")
    points = [_judge_point(reply, m, finer, tolerance, right) for m in range(len(reply.status))]
    order = list(CellVerdict)
    return max(points, key=lambda point: (order.index(point.verdict), point.error or 0.0))


def _judge_point(
    reply: ModelAnswer, m: int, finer: Sequence[ModelAnswer], tolerance: float, right: Sequence[str]
) -> MatrixEntry:
    """Return the verdict on a model's answer at phase pair number `m`; other arguments: as of `judge_answer`."""
    status, mu, error = reply.status[m], reply.mu[m], reply.error[m]
    replies = [(other.status[m], other.mu[m], other.error[m]) for other in finer if len(other.status) > m]
    if status not in (PHYSICAL_OUTCOMES | NUMERICAL_OUTCOMES | {Outcome.OK}):
        return MatrixEntry(CellVerdict.FAILED, f"status {status!r} is no answer of a model", status)
    if right and status != Outcome.OK and status not in right:
        return MatrixEntry(CellVerdict.FAILED, f"refused as {status!r} instead of {' or '.join(right)}", status)
    if status in (Outcome.OK, Outcome.TOLERANCE_NOT_MET):
        return _judge_value(status, mu, error, replies, tolerance)
    if not np.isnan(mu).all():
        return MatrixEntry(CellVerdict.FAILED, f"{status}, and yet a value", status)
    if status in NUMERICAL_OUTCOMES:
        return MatrixEntry(CellVerdict.LIMIT, status, status)
    answered = next((other for other, _, _ in replies if other not in NUMERICAL_OUTCOMES), status)
    if answered != status and status not in right:
        return MatrixEntry(CellVerdict.FAILED, f"{status}, but a finer run: {answered}", status)
    return MatrixEntry(CellVerdict.REFUSED, status, status)


def _judge_value(status: str, mu: Array, error: Array, finer: Sequence[FinerPoint], tolerance: float) -> MatrixEntry:
    """Return the verdict on the amplification mu and its error estimate at one phase pair, checked by finer runs."""
    known = [(value, estimate) for _, value, estimate in finer if np.isfinite(value).all()]
    refused = next((other for other, _, _ in finer), "none")
    unconfirmed = MatrixEntry(CellVerdict.FAILED, f"{status}, but no finer run confirms it: {refused}", status)
    if np.isfinite(mu).all() and np.isnan(error).all():
        return _judge_without_error(status, mu, known[0][0], tolerance) if known else unconfirmed
    if not (np.isfinite(mu).all() and np.isfinite(error).all()):
        return MatrixEntry(CellVerdict.FAILED, f"{status}, but no finite number", status)
    relative = float((error / np.abs(mu)).max()) if (mu != 0.0).all() else float("inf")
    if (error < 0.0).any() or (status == Outcome.OK and relative > tolerance * (1.0 + RELATIVE_ROUNDING)):
        claim = f"an error estimate of {relative:.1e}, asked: {tolerance:g}" if np.isfinite(relative) else "mu = 0"
        reason = f"{status} with {claim}"
        entry = MatrixEntry(CellVerdict.FAILED, reason, status)
    else:
        entry = _judge_by_finer_runs(status, mu, error, relative, known, tolerance) or unconfirmed
    return replace(entry, error=finite_or_none(relative))


def _judge_by_finer_runs(
    status: str, mu: Array, error: Array, relative: float, known: Sequence[tuple[Array, Array]], tolerance: float
) -> MatrixEntry | None:
    """
    Return the verdict of the finer runs on the amplification mu at one phase pair, None if none of them is decisive.

    A run contradicts mu if they differ by more than both errors. It confirms mu if its own error is small enough.
    relative: largest relative error that the model states. known: mu and error of each finer run with a value.
    """
    for value, estimate in known:
        if reason := _word_excess_over_stated_error(value, estimate, mu, error):
            return MatrixEntry(CellVerdict.FAILED, reason, status)
        if (
            status == Outcome.OK
            and (estimate <= np.maximum(error, CONFIRMING_ERROR_SHARE * tolerance * np.abs(mu))).all()
        ):
            return MatrixEntry(CellVerdict.CONVERGED, f"error {relative:.1e} confirmed", status)
    if status == Outcome.TOLERANCE_NOT_MET:
        return MatrixEntry(CellVerdict.LIMIT, f"{status}: {relative:.1e}", status)
    return None


def _word_excess_over_stated_error(finer_mu: Array, finer_error: Array, mu: Array, error: Array) -> str:
    """Return in words how far mu is from that of a finer run; empty if by no more than the sum of both errors."""
    off, allowed = np.abs(mu - finer_mu), error + finer_error + RELATIVE_ROUNDING * np.abs(mu)
    worst = int((off / allowed).argmax())
    times = off[worst] / allowed[worst]
    if not off[worst] > allowed[worst]:
        return ""
    return f"mu_{worst + 1} is off by {off[worst] / abs(mu[worst]):.1e}, {times:.2g} times what is claimed"


def _judge_without_error(status: str, mu: Array, value: Array, tolerance: float) -> MatrixEntry:
    """Return the verdict on amplification mu without error estimate: whether a finer run agrees within `tolerance`."""
    with np.errstate(divide="ignore", invalid="ignore"):
        difference = float(np.nan_to_num(np.abs(mu - value) / np.abs(value), nan=0.0).max())
    verdict = CellVerdict.CONVERGED if difference <= tolerance else CellVerdict.LIMIT
    return MatrixEntry(verdict, f"states no error, off by {difference:.1e}", status)


@dataclass(frozen=True)
class MatrixCell:
    """Cell of the matrix of extremes: one extreme case (row) computed by one model (column)."""

    row: ExtremeCase
    column: ModelColumn


def list_cells(rows: Sequence[ExtremeCase], columns: Sequence[ModelColumn] = COLUMNS) -> list[MatrixCell]:
    """
    Return the cells of the matrix to compute.

    A user's engine is computed at the extremes of the built-in model that it is like, but not at those of Exudyn's own
    numerical parameters.
    """
    pairs = [(row, column) for row in rows for column in columns if (column.like or column.key) in row.columns]
    return [MatrixCell(row, column) for row, column in pairs if not (column.like and row.amplification)]


def solve_cell(cell: MatrixCell) -> MatrixEntry:
    """Compute a model's amplification at an extreme, then finer runs that check it; return the verdict."""
    row, column = cell.row, cell.column
    tolerance = float(row.settings.get("tolerance", column.tolerance))
    begin = time.process_time()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # no warnings of overflow: the answer is judged anyway
        function = row.amplification or column.amplification
        reply = _ask_model(row, function, {**column.settings, **row.settings, "tolerance": tolerance})
        seconds = time.process_time() - begin
        finer = []
        for other, settings, usual in column.finer if makes_checkable_claim(reply) else ():
            # If the finer run calls another function, pass on only those settings of the row that this function has.
            known = {key: value for key, value in row.settings.items() if other == function or key in settings}
            # A row that asks for less error than usual asks as much less of the finer run.
            strict = max(usual * min(1.0, tolerance / column.tolerance), MIN_TOLERANCE)
            finer.append(_ask_model(row, other, {**settings, **known, "tolerance": strict}))
            statuses = finer[-1].status
            if statuses and NUMERICAL_OUTCOMES.isdisjoint(statuses):  # an answer or a refusal at every phase pair
                break
    entry = judge_answer(reply, finer, tolerance, row.invalid, row.right)
    cause = CAUSES.get((row.group, row.title), {}).get(column.key) if entry.verdict == CellVerdict.LIMIT else None
    reason = " ".join(": ".join(filter(None, (entry.reason, cause))).split())
    total = time.process_time() - begin
    return replace(entry, reason=reason, seconds=round(seconds, 3), total=round(total, 3))


def makes_checkable_claim(reply: ModelAnswer) -> bool:
    """
    Return whether finer runs could contradict the answer.

    They could not if the input was refused, if the model failed, or if the stated error is as large as the value.
    """
    return not (reply.invalid or reply.raised) and any(
        (error < np.abs(mu)).any() if status == Outcome.TOLERANCE_NOT_MET else status not in NUMERICAL_OUTCOMES
        for status, mu, error in zip(reply.status, reply.mu, reply.error)
    )


def _ask_model(row: ExtremeCase, function: str, settings: Mapping[str, Any]) -> ModelAnswer:
    """
    Return the answer of a function, stated by its import path, for the scene and the phases of an extreme case.

    If `settings` limit the number of Exudyn's steps ("max_work"), then the limit of the row applies.
    """
    nothing = np.empty((0, 0))
    settings = {key: row.max_work if key == "max_work" else value for key, value in settings.items()}
    try:
        scene = make_extreme_scene(row.scene)
        result = import_function(function)(scene, np.array(row.phases), **settings)
        status = tuple(str(outcome) for outcome in result.status)
        return ModelAnswer(np.array(result.mu, dtype=float), np.array(result.error, dtype=float), status)
    except Exception as error:
        text = word_exception(error)
        if isinstance(error, ValueError) and not isinstance(error, np.linalg.LinAlgError):
            return ModelAnswer(nothing, nothing, (), invalid=text.partition(": ")[2])
        return ModelAnswer(nothing, nothing, (), raised=text)


def make_extreme_scene(stated: Mapping[str, Any]) -> Scene:
    """Return the scene made of the tables of a scene file; a key with the value None is absent. Raises SceneError."""
    try:
        return Scene.model_validate({**stated, "name": "extreme"})
    except ValidationError as error:
        raise first_scene_error("extreme", error, KEYS) from None


@dataclass(frozen=True)
class Extremes:
    """Computations of every model in `columns` at every extreme in `rows`; one is stopped after `limit` s."""

    rows: Sequence[ExtremeCase]
    columns: Sequence[ModelColumn] = COLUMNS
    limit: float = CELL_TIME_LIMIT

    def tasks(self) -> list[Task]:
        """Return one task for each cell of the matrix, row by row."""
        return [self._task(cell) for cell in list_cells(self.rows, self.columns)]

    def collect(self, results: TaskResults) -> Matrix:
        """Return the matrix of verdicts from the results; the command adds times and provenance of the run."""
        entries: dict[tuple[str, str], dict[str, MatrixEntry]] = {}
        for cell in list_cells(self.rows, self.columns):
            row = entries.setdefault((cell.row.group, cell.row.title), {})
            row[cell.column.key] = results.value(self._task(cell), _entry_of_failure)
        used = {key for row in entries.values() for key in row}
        titles = {column.key: column.title for column in self.columns if column.key in used}
        rows = [Extreme(group, title, row) for (group, title), row in entries.items()]
        return Matrix(columns=titles, rows=rows, run={})

    def _task(self, cell: MatrixCell) -> Task:
        """Return the task that judges a model at an extreme; it waits for compiled equations only if it solves them."""
        row, column = cell.row, cell.column
        functions = {row.amplification or column.amplification, *(function for function, _, _ in column.finer)}
        return Task(
            solve_cell,
            cell,
            STAGE,
            seconds=column.seconds if row.quick else SECONDS_OF_LONG_ROWS,
            needs_compiled_reference=EQUATIONS in functions,
            timeout=self.limit,
            group=column.key if column.like else "",
        )


def _entry_of_failure(cell: MatrixCell, failed: TaskResult) -> MatrixEntry:
    """Return the verdict "FAILED" on a cell whose task raised an error, took too long or ended its process."""
    reason = f"{PROCESS_FAILURES.get(failed.outcome, 'raises')} {failed.error_message}"
    return MatrixEntry(CellVerdict.FAILED, reason, failed.outcome.value)


def select_quick(every: Sequence[ExtremeCase]) -> list[ExtremeCase]:
    """Return extreme cases that the equations compute in under 1 s, with Exudyn's models only in a few groups."""
    chosen = [
        replace(
            row,
            columns=tuple(key for key in row.columns if key in REFERENCE_MODELS or row.group in GROUPS_QUICK_BY_ENGINE),
        )
        for row in every
        if row.quick
    ]
    return [row for row in chosen if row.columns]
