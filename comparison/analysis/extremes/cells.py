"""One cell of the matrix of extremes: a model asked, asked again more strictly, and judged, in a worker process."""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from pydantic import ValidationError

from comparison.analysis.extremes.rows import COLUMNS, Column, Row
from comparison.analysis.extremes.verdicts import NUMERICS, Judged, Reply, judged
from comparison.study.batches import imported
from reference.problem import Outcome, Scene
from reference.problem.scene import KEYS
from reference.problem.scene_error import first_error

STRICTEST = 1e-10  # relative error that a model can be asked for


@dataclass(frozen=True)
class Cell:
    """An extreme and the model that meets it."""

    row: Row
    column: Column


@dataclass(frozen=True)
class Solved:
    """What came of a cell, and processor time in s: of the model's answer, and in all with the finer runs."""

    judged: Judged
    seconds: float
    total: float


def cells(rows: Sequence[Row], columns: Sequence[Column] = COLUMNS) -> list[Cell]:
    """Every model that each extreme concerns."""
    return [Cell(row, column) for row in rows for column in columns if column.key in row.columns]


def solve_cell(cell: Cell) -> Solved:
    """Run the cell and judge it."""
    row, column = cell.row, cell.column
    tolerance = float(row.settings.get("tolerance", column.tolerance))
    begin = time.process_time()
    asked_function = row.amplification or column.amplification
    reply = _ask(row, asked_function, {**column.settings, **row.settings, "tolerance": tolerance})
    seconds = time.process_time() - begin
    finer: list[Reply] = []
    for function, settings, asked in column.finer if _answers(reply) else ():
        share = min(1.0, tolerance / column.tolerance)
        # another function knows only what its own settings name
        known = {key: value for key, value in row.settings.items() if function == asked_function or key in settings}
        stricter = {**settings, **known, "tolerance": max(asked * share, STRICTEST)}
        finer.append(_ask(row, function, stricter))
        if _confirms(finer[-1], reply):
            break
    verdict = judged(reply, finer, tolerance, row.invalid, row.right)
    return Solved(replace(verdict, reason=" ".join(verdict.reason.split())), seconds, time.process_time() - begin)


def _answers(reply: Reply) -> bool:
    """Whether there is anything that a finer run could contradict."""
    return not (reply.invalid or reply.raised) and any(
        status == Outcome.TOLERANCE_NOT_MET or status not in NUMERICS for status in reply.status
    )


def _confirms(finer: Reply, reply: Reply) -> bool:
    """Whether the finer run has something to say at every point."""
    return bool(finer.status) and all(status not in NUMERICS for status in finer.status)


def _ask(row: Row, function: str, settings: Mapping[str, Any]) -> Reply:
    nothing = np.empty((0, 0))
    try:
        scene = _scene(row.scene)
        result = imported(function)(scene, np.array(row.phases), **settings)
        status = tuple(str(outcome) for outcome in result.status)
        return Reply(np.array(result.mu, dtype=float), np.array(result.error, dtype=float), status)
    except Exception as error:
        text = f"{type(error).__name__}: {error}"
        if isinstance(error, ValueError) and not isinstance(error, np.linalg.LinAlgError):
            return Reply(nothing, nothing, (), invalid=str(error))
        return Reply(nothing, nothing, (), raised=text)


def _scene(written: Mapping[str, Any]) -> Scene:
    """The scene as a file would give it: keys without a value are absent. Raises SceneError."""
    try:
        return Scene.model_validate({**_given(written), "name": "extreme"})
    except ValidationError as error:
        raise first_error("extreme", error, KEYS) from None


def _given(written: Mapping[str, Any]) -> dict[str, Any]:
    return dict(_kept(written))


def _kept(written: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
    for key, value in written.items():
        if value is not None:
            yield key, _given(value) if isinstance(value, Mapping) else value
