"""Matrix of extremes as data: the verdict on every model at every extreme, for its file and the report."""

from collections import Counter
from collections.abc import Mapping, Sequence
from enum import StrEnum
from itertools import groupby
from typing import Annotated, Any

from comparison.json_file import StoredFile
from comparison.result_types import require, result

FILE = "extremes.json"  # name of the file with the matrix of verdicts on every model at every extreme


class CellVerdict(StrEnum):
    """Verdicts on a model at an extreme, from best to worst; a cell has the verdict on its worst phase pair."""

    CONVERGED = "converged"
    REFUSED = "refused"
    LIMIT = "limit"
    FAILED = "FAILED"


MEANING_OF_VERDICT = {  # explanation of each verdict for the report
    CellVerdict.CONVERGED: "converged: error claimed, confirmed by a finer run",
    CellVerdict.REFUSED: "refused: against a rule, or the motion leaves the model",
    CellVerdict.LIMIT: "limit: the model says that it cannot",
    CellVerdict.FAILED: "FAILED: no answer, or a wrong one",
}


@result
class MatrixEntry:
    """Cell of the matrix of extremes: verdict on one model at one extreme, with reason, error and time."""

    verdict: CellVerdict
    """converged: error confirmed by a finer run; refused: against a rule or outside the model; limit: the model says
    that it cannot; FAILED: all else"""
    reason: Annotated[str, "in a few words"]
    status: str = ""
    """outcome that decides the verdict, in the words of `reference.problem.Outcome`; empty for an input against a rule
    and for an error that was raised"""
    error: Annotated[float | None, "largest relative error estimate; null without a value"] = None
    seconds: Annotated[float | None, "processor time of the model's answer, s; null without an answer"] = None
    total: Annotated[float | None, "processor time of the cell with its finer runs, s; null without an answer"] = None


@result
class Extreme:
    """Row of the matrix of extremes: one quantity at one extreme value, with the verdict on each model."""

    group: Annotated[str, "the quantity"]
    title: Annotated[str, "its extreme value"]
    entries: Annotated[
        Mapping[str, MatrixEntry], "by key of the model; none for a model that the extreme does not concern"
    ]


@result
class Matrix:
    """Matrix of verdicts on every model (columns) at the extremes of every quantity (rows), checked by finer runs."""

    columns: Annotated[Mapping[str, str], "titles of the models by key"]
    rows: Annotated[Sequence[Extreme], "one per extreme"]
    run: Annotated[Mapping[str, Any], "command, times, provenance, and whether it is the reduced form"]

    def __post_init__(self) -> None:
        """Raise an error if a row has a verdict on a model that is not among the columns."""
        for row in self.rows:
            for key in row.entries:
                require(key in self.columns, f"model {key[:40]!r} of a row is none of the columns")

    def counts(self) -> dict[str, int]:
        """Return the number of cells of each verdict, from the best to the worst, zeros included."""
        seen = Counter(entry.verdict for row in self.rows for entry in row.entries.values())
        return {verdict.value: seen[verdict] for verdict in CellVerdict}

    @property
    def count_line(self) -> str:
        """Return the number of cells, and of those with each verdict, in one line of text."""
        counts = self.counts()
        return f"{sum(counts.values())} cells: {', '.join(f'{n} {verdict}' for verdict, n in counts.items())}"

    def groups(self) -> list[list[Extreme]]:
        """Return the rows of the matrix grouped by the quantity that is extreme in them."""
        return [list(rows) for _, rows in groupby(self.rows, key=lambda row: row.group)]

    def cells_of(self, verdict: str) -> list[tuple[Extreme, str, MatrixEntry]]:
        """Return row, column title and entry of all cells with the given verdict."""
        return [
            (row, self.columns[key], entry)
            for row in self.rows
            for key, entry in row.entries.items()
            if entry.verdict == verdict
        ]


STORED = StoredFile(name=FILE, kind=Matrix, what="a matrix of extremes", command="phase-resonance extremes")


def describe_entry(entry: MatrixEntry) -> str:
    """Return the text of a cell of the matrix: the relative error that the model claims, or the outcome."""
    if entry.verdict == CellVerdict.CONVERGED and entry.error is not None:
        return f"{entry.error:.0e}"
    return "FAILED" if entry.verdict == CellVerdict.FAILED else entry.status or "against a rule"
