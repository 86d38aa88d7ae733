"""One cell of the matrix of extremes: a model's answer, the same asked more strictly, and the verdict."""

from __future__ import annotations

import time
import warnings
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from pydantic import ValidationError

from comparison.analyses.extremes.causes import CAUSES
from comparison.analyses.extremes.matrix import Entry
from comparison.analyses.extremes.rows import COLUMNS, Column, Row
from comparison.analyses.extremes.verdicts import NUMERICS, Reply, Verdict, judged
from comparison.json_file import finite_or_none
from comparison.study.batches import imported
from comparison.wording import exception_line
from reference.problem import Outcome, Scene
from reference.problem.scene import KEYS
from reference.problem.scene_error import first_error

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
        reply = _ask(row, function, {**_with_work(column.settings, row), **row.settings, "tolerance": tolerance})
        seconds = time.process_time() - begin
        finer = list(_finer_replies(cell, function, tolerance)) if answers(reply) else []
    verdict = judged(reply, finer, tolerance, row.invalid, row.right)
    error = finite_or_none(verdict.error)
    total = time.process_time() - begin
    cause = CAUSES.get((row.group, row.title), {}).get(column.key) if verdict.verdict == Verdict.LIMIT else None
    reason = " ".join(": ".join(filter(None, (verdict.reason, cause))).split())
    return Entry(verdict.verdict, reason, verdict.status, error, round(seconds, 3), round(total, 3))


def _finer_replies(cell: Cell, answered_by: str, tolerance: float) -> Iterator[Reply]:
    """What the finer runs of the column say, until one has an answer at every point."""
    row, column = cell.row, cell.column
    for function, settings, usual in column.finer:
        share = min(1.0, tolerance / column.tolerance)
        # another function knows only what its own settings name
        known = {key: value for key, value in row.settings.items() if function == answered_by or key in settings}
        reply = _ask(row, function, {**_with_work(settings, row), **known, "tolerance": max(usual * share, STRICTEST)})
        yield reply
        if _is_complete(reply):
            return


def _with_work(settings: Mapping[str, Any], row: Row) -> dict[str, Any]:
    """The settings, those of an engine with the work that the row allows."""
    return {**settings, "max_work": row.max_work} if "max_work" in settings else dict(settings)


def answers(reply: Reply) -> bool:
    """Whether there is anything that a finer run could contradict: not a value whose error is as large as itself."""
    return not (reply.invalid or reply.raised) and any(
        (error < np.abs(mu)).any() if status == Outcome.TOLERANCE_NOT_MET else status not in NUMERICS
        for status, mu, error in zip(reply.status, reply.mu, reply.error)
    )


def _is_complete(reply: Reply) -> bool:
    """Whether there is an answer, be it a refusal, at every point."""
    return bool(reply.status) and all(status not in NUMERICS for status in reply.status)


def _ask(row: Row, function: str, settings: Mapping[str, Any]) -> Reply:
    nothing = np.empty((0, 0))
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
