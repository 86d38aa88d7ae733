"""The matrix of extremes as data: what every model made of every extreme, as a file and as the report needs it."""

from __future__ import annotations

import json
import math
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from itertools import groupby
from pathlib import Path
from typing import Annotated, Any

from pydantic import AfterValidator, Field

from comparison.analysis.extremes.cells import Cell, Solved
from comparison.analysis.extremes.rows import Column
from comparison.analysis.extremes.verdicts import Judged, Verdict
from comparison.analysis.extremes.worker import NoAnswer
from comparison.analysis.stored import FILE_FORMAT, load_file

FILE, PICTURE = "extremes.json", "extremes.png"


VerdictName = Annotated[
    str,
    AfterValidator(lambda name: Verdict(name).value),
    Field(json_schema_extra={"enum": [verdict.value for verdict in Verdict]}),
]


@dataclass(frozen=True)
class Entry:
    """One cell of the matrix."""

    __pydantic_config__ = FILE_FORMAT

    verdict: VerdictName
    """converged: error confirmed by a finer run; refused: against a rule or outside the model; limit: the model says
    that it cannot; FAILED: all else"""
    reason: str
    """in a few words"""
    error: float | None
    """largest relative error estimate; null without a value"""
    seconds: float | None
    """processor time of the model's answer, s; null without an answer"""
    total: float | None
    """processor time of the cell with its finer runs, s; null without an answer"""


@dataclass(frozen=True)
class Extreme:
    """One row of the matrix: one extreme."""

    __pydantic_config__ = FILE_FORMAT

    group: str
    """the quantity"""
    title: str
    """its extreme value"""
    entries: Mapping[str, Entry]
    """what came of it, by key of the model; none for a model that the extreme does not concern"""


@dataclass(frozen=True)
class Matrix:
    """Every model at the extremes of every quantity, judged by finer runs."""

    __pydantic_config__ = FILE_FORMAT

    columns: Mapping[str, str]
    """titles of the models by key"""
    rows: Sequence[Extreme]
    """one per extreme"""
    run: Mapping[str, Any]
    """command, times, provenance, and whether it is the reduced form"""

    def counts(self) -> dict[str, int]:
        """Number of cells of each verdict, in the order from best to worst."""
        seen = Counter(entry.verdict for row in self.rows for entry in row.entries.values())
        return {verdict.value: seen[verdict.value] for verdict in Verdict}

    def groups(self) -> list[list[Extreme]]:
        """The rows that share a quantity."""
        return [list(rows) for _, rows in groupby(self.rows, key=lambda row: row.group)]

    def listed(self, verdict: str) -> list[tuple[Extreme, str, Entry]]:
        """The rows, titles of columns and entries with this verdict."""
        return [
            (row, self.columns[key], entry)
            for row in self.rows
            for key, entry in row.entries.items()
            if entry.verdict == verdict
        ]


def matrix(
    cells: Sequence[Cell], results: Sequence[Solved | NoAnswer], columns: Sequence[Column], run: Mapping[str, Any]
) -> Matrix:
    """Results laid out by extreme and model."""
    rows: dict[tuple[str, str], dict[str, Entry]] = {}
    for cell, result in zip(cells, results):
        row = rows.setdefault((cell.row.group, cell.row.title), {})
        row[cell.column.key] = as_entry(result)
    used = {key for entries in rows.values() for key in entries}
    titles = {column.key: column.title for column in columns if column.key in used}
    return Matrix(titles, [Extreme(group, title, entries) for (group, title), entries in rows.items()], run)


def as_entry(result: Solved | NoAnswer) -> Entry:
    """The result as it is shown; no answer at all is a failure."""
    if isinstance(result, NoAnswer):
        return Entry(Verdict.FAILED.value, result.why, None, None, None)
    verdict: Judged = result.judged
    error = verdict.error if math.isfinite(verdict.error) else None
    return Entry(verdict.verdict.value, verdict.reason, error, round(result.seconds, 3), round(result.total, 3))


def as_json(found: Matrix) -> bytes:
    """The content of the file."""
    return (json.dumps(asdict(found), indent=1, ensure_ascii=False, allow_nan=False) + "\n").encode()


def load(folder: Path) -> Matrix | None:
    """The matrix that `as_json` left in the folder, None if there is none. Raises ValueError if it is another file."""
    return load_file(folder / FILE, Matrix, "a matrix of extremes", "python -m comparison.extremes")
